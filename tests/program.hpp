// For tests that run the program as users do. Tests only; MYRIAD_PROGRAM is its path.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tools/temp_folder.hpp"

namespace myriad::tools {

using Arguments = std::vector<std::string>;
using Environment = std::vector<std::pair<std::string, std::string>>;

inline Arguments operator+(Arguments a, const Arguments& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

inline Environment operator+(Environment a, const Environment& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

struct Outcome {
    int status = -1;  // 128 + signal when one ended it, as in a shell
    std::string out, err;
    std::ptrdiff_t error_lines() const { return std::ranges::count(err, '\n'); }
};

inline int status_of(int wait_status) { return WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : 128 + WTERMSIG(wait_status); }

// Starts a program with its outputs in files (or wherever `err` says) and returns its process.
inline pid_t start(const Arguments& arguments, const Environment& environment, const std::string& out, const std::string& err, int err_fd = -1,
                   const char* program = MYRIAD_PROGRAM) {
    const pid_t child = fork();
    if (child) return child;
    signal(SIGINT, SIG_DFL);  // background shells ignore it, and so would the program
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    const auto to = [](const std::string& path) { return open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666); };
    dup2(to(out), STDOUT_FILENO);
    dup2(err_fd < 0 ? to(err) : err_fd, STDERR_FILENO);
    std::vector<char*> argv = {const_cast<char*>("myriad")};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    execv(program, argv.data());
    _exit(127);
}

// Lines that speak of the test machine and not of the run.
inline std::string without_setup_warnings(const std::string& text) {
    std::string kept;
    for (size_t at = 0; at < text.size();) {
        const size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
        const std::string line = text.substr(at, end - at);
        if (!contains(line, "the Khronos validation layer is not installed")) kept += line;
        at = end;
    }
    return kept;
}

inline Outcome myriad_program(const Arguments& arguments, const Environment& environment = {}, const char* program = MYRIAD_PROGRAM) {
    const TempFolder pipes;
    int status = 0;
    waitpid(start(arguments, environment, pipes / "out", pipes / "err", -1, program), &status, 0);
    return {status_of(status), bytes_of(pipes / "out"), without_setup_warnings(bytes_of(pipes / "err"))};
}

inline const Arguments tiny = {"render", "builtin:cornell", "--size", "64x48", "--vpls", "64", "--samples", "12"};

}  // namespace myriad::tools
