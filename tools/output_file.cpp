#include "tools/output_file.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <climits>
#include <cstring>
#include <utility>

#include "engine/error.hpp"

namespace myriad::tools {
namespace {

namespace fs = std::filesystem;

// ---- The registry of temporaries: plain memory and lock-free flags, for a signal handler reads it. A path is entered
// before its file exists and leaves after the rename, so there is no moment at which a file is missed; unlinking a name
// that is not there does no harm.

struct Slot {
    std::atomic<bool> taken, live;
    std::atomic<pid_t> owner;  // a forked process has the registry, but not the files
    char path[PATH_MAX];
};
static_assert(std::atomic<bool>::is_always_lock_free);
std::array<Slot, 32> slots;  // more than a run ever writes at once (image, PNG, AOVs, stats, trace)

// The slot, or -1 when the path does not fit or all are taken.
int enter(const std::string& path) {
    if (path.size() >= PATH_MAX) return -1;
    for (size_t i = 0; i < slots.size(); ++i) {
        if (slots[i].taken.exchange(true)) continue;
        std::memcpy(slots[i].path, path.c_str(), path.size() + 1);
        slots[i].owner = getpid();
        slots[i].live = true;
        return static_cast<int>(i);
    }
    return -1;
}

void leave(int slot) {
    if (slot < 0) return;
    slots[slot].live = false;
    slots[slot].taken = false;
}

bool entered(const std::string& path) {
    for (const Slot& slot : slots)
        if (slot.live && path == slot.path) return true;
    return false;
}

// Async-signal-safe, as everything in a handler must be.
extern "C" void on_signal(int signal) {
    remove_temporaries();
    _exit(128 + signal);
}

extern "C" void on_crash(int signal) {  // the handler is gone by now, so that the crash goes its way
    remove_temporaries();
    raise(signal);
}

// ----

std::string explain(int error, const fs::path& folder) {
    const std::string in = "the folder '" + folder.string() + "'";
    switch (error) {
        case ENOENT: return in + " does not exist; create it or choose another path";
        case ENOTDIR: return in + " is a file; choose another path";
        case EACCES:
        case EPERM: return in + " may not be written to; change its permissions or choose another path";
        case EROFS: return in + " is on a read-only file system; choose another path";
        case ENOSPC:
        case EDQUOT: return "the disk is full; free some space or choose another path";
        case EFBIG: return "the file is larger than the system allows; raise the limit (ulimit -f) or choose a smaller size";
        case ENAMETOOLONG: return "the name is too long; choose a shorter one";
        default: return std::string(std::strerror(error)) + "; choose another path";
    }
}

// Makes the rename itself durable. Best effort: some file systems cannot.
void sync_folder(const fs::path& folder) {
    if (int fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); fd >= 0) {
        fsync(fd);
        close(fd);
    }
}

}  // namespace

OutputFile::OutputFile(const fs::path& target) : name_(target.string()) {
    const std::string cannot = "cannot write '" + name_ + "': ";
    if (!target.has_filename()) throw InputError(cannot + "it names no file; add a file name");

    std::error_code none;
    target_ = fs::absolute(target);
    if (fs::is_symlink(target_, none))  // replace what the link points at, not the link
        if (fs::path real = fs::canonical(target_, none); !none) target_ = real;

    struct stat old {};
    const bool exists = stat(target_.c_str(), &old) == 0;
    if (exists && S_ISDIR(old.st_mode)) throw InputError(cannot + "it is a folder; name a file in it");
    if (exists && access(target_.c_str(), W_OK) != 0)
        throw InputError(cannot + "the file is write-protected; change its permissions or choose another path");

    int fd = -1;
    if (exists && !S_ISREG(old.st_mode)) {
        fd = open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    } else {
        temporary_ = target_.parent_path() / ("." + target_.filename().string() + ".tmp-" + std::to_string(getpid()));
        if (entered(temporary_)) throw InputError(cannot + "this run writes that file already; give each output its own name");
        slot_ = enter(temporary_);
        if (slot_ < 0) throw InputError(cannot + "too many outputs at once, or too long a path; choose a shorter one");
        auto create = [&] { return open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); };
        fd = create();
        // Left by a killed run whose process number came round again, as it does in containers.
        if (fd < 0 && errno == EEXIST && unlink(temporary_.c_str()) == 0) fd = create();
        if (fd >= 0 && exists) fchmod(fd, old.st_mode & 07777);  // keeps the mode where that is allowed
    }
    if (fd >= 0) file_ = fdopen(fd, "wb");
    if (!file_) {
        const int error = errno;
        if (fd >= 0) close(fd);
        discard();
        fail(error);
    }
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::write(const void* bytes, size_t count) {
    if (count && fwrite(bytes, 1, count, file_) != count) fail(errno);
}

void OutputFile::seek(uint64_t offset) {
    if (fseeko(file_, static_cast<off_t>(offset), SEEK_SET) != 0) fail(errno);
}

uint64_t OutputFile::tell() {
    const off_t at = ftello(file_);
    if (at < 0) fail(errno);
    return static_cast<uint64_t>(at);
}

void OutputFile::commit() {
    assert(file_);
    if (error_) fail(error_);
    if (fflush(file_) != 0) fail(errno);
    // Pipes and some file systems have nothing to sync; that is no failure.
    if (fsync(fileno(file_)) != 0 && errno != EINVAL && errno != ENOTSUP && errno != EROFS) fail(errno);
    FILE* file = std::exchange(file_, nullptr);
    if (fclose(file) != 0) fail(errno);
    if (temporary_.empty()) return;
    if (rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
    temporary_.clear();
    leave(std::exchange(slot_, -1));
    sync_folder(target_.parent_path());
}

void OutputFile::fail(int error) {
    error_ = error;
    const fs::path folder = fs::path(name_).parent_path();
    throw InputError("cannot write '" + name_ + "': " + explain(error, folder.empty() ? "." : folder));
}

void OutputFile::discard() {
    if (FILE* file = std::exchange(file_, nullptr)) fclose(file);
    if (!temporary_.empty()) unlink(temporary_.c_str());
    temporary_.clear();
    leave(std::exchange(slot_, -1));
}

void write_text(const fs::path& path, std::string_view text) {
    OutputFile file(path);
    file.write(text);
    file.commit();
}

void require_writable(const fs::path& path) { OutputFile probe(path); }

void remove_temporaries() noexcept {
    for (const Slot& slot : slots)
        if (slot.live && slot.owner == getpid()) unlink(slot.path);
}

void remove_temporaries_on_signal() {
    signal(SIGXFSZ, SIG_IGN);  // so that a write beyond `ulimit -f` is an error and not the end
    const auto handle = [](int signal, void (*handler)(int), int flags) {
        struct sigaction old {}, action {};
        sigaction(signal, nullptr, &old);
        if ((old.sa_flags & SA_SIGINFO) || old.sa_handler != SIG_DFL) return;  // the parent ignores it, or a sanitiser has it
        action.sa_handler = handler;
        action.sa_flags = flags;
        sigfillset(&action.sa_mask);
        sigaction(signal, &action, nullptr);
    };
    for (int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU}) handle(signal, on_signal, 0);
    for (int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) handle(signal, on_crash, SA_RESETHAND);
}

}  // namespace myriad::tools
