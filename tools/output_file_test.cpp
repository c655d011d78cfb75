#include "tools/output_file.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tools/temp_folder.hpp"

namespace myriad::tools {
namespace {

using Names = std::vector<std::string>;

// Runs the action as a user who may not write everywhere, in a child, for root may: its exit status.
template <class Action>
int status_of_child(Action action) {
    const pid_t child = fork();
    if (child == 0) _exit(action());
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST(output_file, target_is_untouched_until_commit) {
    TempFolder folder;
    const auto target = folder / "a.txt";
    put(target, "old");
    {
        OutputFile file(target);
        file.write("new");
        EXPECT_EQ(folder.names(), (Names{".a.txt.tmp-" + std::to_string(getpid()), "a.txt"}));
        EXPECT_EQ(bytes_of(target), "old");
    }
    EXPECT_EQ(bytes_of(target), "old");
    EXPECT_EQ(folder.names(), (Names{"a.txt"}));

    OutputFile file(target);
    file.write("new, longer");
    file.seek(0);
    file.write("NEW");
    EXPECT_EQ(file.tell(), 3u);
    file.commit();
    EXPECT_EQ(bytes_of(target), "NEW, longer");
    EXPECT_EQ(folder.names(), (Names{"a.txt"}));
}

TEST(output_file, an_exception_leaves_nothing) {
    TempFolder folder;
    try {
        OutputFile file(folder / "a");
        file.write("half");
        throw 1;
    } catch (int) {
    }
    EXPECT_EQ(folder.names(), Names{});
}

TEST(output_file, keeps_the_mode_and_follows_links) {
    TempFolder folder;
    put(folder / "real", "old");
    chmod((folder / "real").c_str(), 0640);
    std::filesystem::create_symlink("real", folder / "link");
    write_text(folder / "link", "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(bytes_of(folder / "real"), "new");
    struct stat info {};
    stat((folder / "real").c_str(), &info);
    EXPECT_EQ(info.st_mode & 0777, 0640u);
}

TEST(output_file, devices_are_written_in_place) {
    write_text("/dev/null", "text");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    const std::string full = input_error([] { write_text("/dev/full", "text"); });
    EXPECT_TRUE(contains(full, "'/dev/full'") && contains(full, "disk is full")) << full;
}

TEST(output_file, an_early_failure_is_not_forgotten) {  // OpenEXR swallows exceptions at the end of a file
    OutputFile file("/dev/full");
    EXPECT_THROW(file.write(std::string(1 << 20, 'x')), InputError);
    EXPECT_THROW(file.commit(), InputError);
}

TEST(output_file, errors_name_file_and_cure) {
    TempFolder folder;
    const std::string missing = input_error([&] { write_text(folder / "none/a.exr", ""); });
    EXPECT_TRUE(contains(missing, "none/a.exr") && contains(missing, "does not exist; create it")) << missing;
    EXPECT_TRUE(contains(input_error([&] { require_writable(folder.path); }), "it is a folder"));
    EXPECT_TRUE(contains(input_error([&] { require_writable(folder.path.string() + "/"); }), "names no file"));
    EXPECT_TRUE(contains(input_error([&] { require_writable(""); }), "names no file"));
    put(folder / "file", "");
    EXPECT_TRUE(contains(input_error([&] { require_writable(folder / "file/a"); }), "is a file"));
    EXPECT_TRUE(contains(input_error([&] { require_writable(folder / std::string(300, 'n')); }), "too long"));
    OutputFile first(folder / "twice");
    EXPECT_TRUE(contains(input_error([&] { require_writable(folder / "twice"); }), "already"));
    require_writable(folder / "fine");
    EXPECT_EQ(folder.names().back(), "file") << "asking leaves nothing";
}

TEST(output_file, read_only_folder_and_file) {
    TempFolder folder;
    put(folder / "locked", "old");
    chmod((folder / "locked").c_str(), 0444);
    chmod(folder.path.c_str(), 0555);
    std::string message;
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const int status = status_of_child([&] {
        if (getuid() == 0 && setuid(65534) != 0) return 9;
        for (const char* name : {"new", "locked"}) {
            try {
                require_writable(folder / name);
                return 1;
            } catch (const InputError& e) {
                const std::string line = std::string(e.what()) + "\n";
                if (::write(ends[1], line.data(), line.size()) < 0) return 8;
            }
        }
        return 0;
    });
    close(ends[1]);
    char buffer[2048];
    const ssize_t count = read(ends[0], buffer, sizeof buffer);
    close(ends[0]);
    message.assign(buffer, count > 0 ? static_cast<size_t>(count) : 0);
    chmod(folder.path.c_str(), 0755);
    EXPECT_EQ(status, 0);
    EXPECT_TRUE(contains(message, "may not be written to") && contains(message, "write-protected")) << message;
    EXPECT_EQ(folder.names(), (Names{"locked"}));
}

TEST(output_file, a_full_disk_keeps_the_old_file) {
    TempFolder folder;
    put(folder / "a", "old");
    EXPECT_EQ(status_of_child([&] {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{4096, 4096};
        setrlimit(RLIMIT_FSIZE, &limit);
        try {
            write_text(folder / "a", std::string(100'000, 'x'));
            return 1;
        } catch (const InputError& e) {
            return contains(e.what(), "larger than the system allows") ? 0 : 2;
        }
    }), 0);
    EXPECT_EQ(bytes_of(folder / "a"), "old");
    EXPECT_EQ(folder.names(), (Names{"a"}));
}

TEST(output_file, a_stale_temporary_of_the_same_process_number_is_replaced) {
    TempFolder folder;
    put(folder / (".a.tmp-" + std::to_string(getpid())), "stale");
    write_text(folder / "a", "new");
    EXPECT_EQ(folder.names(), (Names{"a"}));
    EXPECT_EQ(bytes_of(folder / "a"), "new");
}

TEST(output_file, more_outputs_than_slots_fail_cleanly) {
    TempFolder folder;
    std::vector<std::unique_ptr<OutputFile>> files;
    EXPECT_TRUE(contains(input_error([&] {
        for (int i = 0; i < 100; ++i) files.push_back(std::make_unique<OutputFile>(folder / std::to_string(i)));
    }), "too many"));
    files.clear();
    EXPECT_EQ(folder.names(), Names{});
    write_text(folder / "again", "");
}

class output_file_signals : public testing::TestWithParam<int> {};

TEST_P(output_file_signals, leave_no_temporary) {
    TempFolder folder;
    put(folder / "a", "old");
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        remove_temporaries_on_signal();
        OutputFile a(folder / "a"), b(folder / "b");
        a.write("half of it");
        (void)!::write(ends[1], "!", 1);
        for (;;) pause();
    }
    char ready = 0;
    ASSERT_EQ(read(ends[0], &ready, 1), 1);
    EXPECT_EQ(folder.names().size(), 3u);
    kill(child, GetParam());
    int status = 0;
    waitpid(child, &status, 0);
    close(ends[0]);
    close(ends[1]);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 128 + GetParam());
    EXPECT_EQ(folder.names(), (Names{"a"}));
    EXPECT_EQ(bytes_of(folder / "a"), "old");
}

INSTANTIATE_TEST_SUITE_P(each, output_file_signals, testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU));

// A crash, and a fork that crashes: whose files they are, he removes them.
TEST(output_file, a_crash_leaves_no_temporary) {
    for (int sent : {SIGSEGV, SIGABRT}) {
        const TempFolder folder;
        const pid_t child = fork();
        if (child == 0) {
            for (int signal : {SIGSEGV, SIGABRT}) ::signal(signal, SIG_DFL);  // a sanitiser's
            remove_temporaries_on_signal();
            OutputFile a(folder / "a");
            if (fork() == 0) raise(sent);
            wait(nullptr);
            if (folder.names().size() != 1) _exit(1);
            raise(sent);
        }
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == sent) << "it stays a crash";
        EXPECT_EQ(folder.names(), Names());
    }
}

TEST(output_file, ignored_signals_stay_ignored) {  // nohup
    EXPECT_EQ(status_of_child([] {
        signal(SIGHUP, SIG_IGN);
        remove_temporaries_on_signal();
        raise(SIGHUP);
        return 5;
    }), 5);
}

}  // namespace
}  // namespace myriad::tools
