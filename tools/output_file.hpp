// Output that is whole or absent: every file that Myriad writes goes through here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace myriad::tools {

// Writes `.NAME.tmp-PID` beside the target; commit() makes it durable and renames it over the target, so that a reader
// sees the old file or the whole new one. Without commit() the destructor removes it and the target stays as it was.
//
// A target that exists and is no regular file (/dev/stdout, a pipe) is written in place: it cannot be replaced.
// Every failure (missing folder, read-only, disk full …) is an InputError that names the file and the cure.
class OutputFile {
public:
    explicit OutputFile(const std::filesystem::path& target);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(const void* bytes, size_t count);
    void write(std::string_view text) { write(text.data(), text.size()); }
    void seek(uint64_t offset);  // bytes from the beginning
    uint64_t tell();

    // Throws also when an earlier write failed and its exception was swallowed on the way (OpenEXR does that).
    void commit();

private:
    [[noreturn]] void fail(int error);
    void discard();

    std::string name_;                         // as the user wrote it, for messages
    std::filesystem::path target_, temporary_;  // absolute; no temporary when written in place
    FILE* file_ = nullptr;
    int slot_ = -1;  // in the registry of temporaries
    int error_ = 0;  // errno of the first failure
};

// The whole text, atomically.
void write_text(const std::filesystem::path& path, std::string_view text);

// InputError when an OutputFile could not be opened there. For asking before an hour of rendering, not after it.
void require_writable(const std::filesystem::path& path);

// The open temporaries of this process are no more: for an end without destructors. Safe in a signal handler.
void remove_temporaries() noexcept;

// From now on SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE and SIGXCPU remove the open temporaries of this process and end it with
// 128 + signal (130, 143, 129 …), a crash removes them too and stays one, and a file that grows too large (`ulimit -f`) is an
// error like a full disk. Signals that the parent ignores (nohup) stay ignored. Call once, from main.
void remove_temporaries_on_signal();

}  // namespace myriad::tools
