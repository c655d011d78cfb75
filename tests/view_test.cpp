// `myriad view` in a real window: Xvfb is the screen, xdotool the hands. What is waited for is what the viewer says with --verbose.
#include <sys/wait.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>

#include "tests/program.hpp"
#include "tools/png.hpp"

namespace myriad::tools {
bool drop_file(const std::string& display, unsigned long window, const std::string& path);  // drop.cpp; X11's names are kept apart
namespace {

using namespace std::chrono_literals;

int shell(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()); }

std::string output_of(const std::string& command) {
    std::string text;
    FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
    for (int c; pipe && (c = fgetc(pipe)) != EOF;) text += char(c);
    if (pipe) pclose(pipe);
    return text;
}

// A screen that nobody sees, on a display that is free.
class Screen {
public:
    Screen() {
        int ends[2];
        if (pipe(ends) != 0) return;
        server_ = fork();
        if (server_ == 0) {
            close(ends[0]);
            const int null = open("/dev/null", O_RDWR);
            dup2(null, STDOUT_FILENO), dup2(null, STDERR_FILENO);
            const std::string fd = std::to_string(ends[1]);
            execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", "1280x800x24", "-nolisten", "tcp", nullptr);
            _exit(127);
        }
        close(ends[1]);
        std::string number;
        for (char c; ::read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
        close(ends[0]);
        if (!number.empty()) display = ":" + number;
    }
    ~Screen() {
        if (server_ <= 0) return;
        kill(server_, SIGTERM);
        waitpid(server_, nullptr, 0);
    }
    std::string display;

private:
    pid_t server_ = -1;
};

class view_window : public testing::Test {
protected:
    void SetUp() override {
        for (const char* program : {"Xvfb", "xdotool"})
            if (shell("command -v " + std::string(program))) GTEST_SKIP() << "no " << program << " here; apt-get install xvfb xdotool";
        screen_.emplace();
        ASSERT_FALSE(screen_->display.empty()) << "Xvfb does not start";
    }
    void TearDown() override {
        if (viewer_ > 0) kill(viewer_, SIGKILL), waitpid(viewer_, nullptr, 0);
    }

    void start(const std::string& arguments) {
        log_ = folder / "log";
        viewer_ = fork();
        if (viewer_ == 0) {
            if (chdir(folder.path.c_str()) != 0) _exit(126);
            setenv("DISPLAY", screen_->display.c_str(), 1), setenv("XDG_CONFIG_HOME", (folder / "config").c_str(), 1), setenv("MYRIAD_VALIDATION", "1", 1);
            unsetenv("WAYLAND_DISPLAY");
            execl("/bin/sh", "sh", "-c", ("exec " MYRIAD_PROGRAM " view " + arguments + " --verbose 2>log").c_str(), nullptr);
            _exit(127);
        }
        await("view: ready");
        for (int i = 0; i < 200 && window_.empty(); ++i, std::this_thread::sleep_for(20ms)) window_ = line(output_of(hands("search --name Myriad")));
        ASSERT_FALSE(window_.empty()) << log();
        hand("windowfocus " + window_);
    }

    static std::string line(const std::string& text) { return text.substr(0, text.find('\n')); }
    std::string log() const { return bytes_of(log_); }
    std::string hands(const std::string& what) const { return "DISPLAY=" + screen_->display + " xdotool " + what; }
    void hand(const std::string& what) { EXPECT_EQ(shell(hands(what)), 0) << what; }

    // The first line from where the last one ended that has `part` in it. A minute at most, for machines can be busy; none once something has failed.
    std::string await(const std::string& part) {
        for (int i = 0; i < 3000 && !HasFailure(); ++i, std::this_thread::sleep_for(20ms)) {
            const std::string text = log();
            const size_t at = text.find(part, heard_);
            const size_t end = at == std::string::npos ? at : text.find('\n', at);
            if (end != std::string::npos) {
                heard_ = end + 1;
                const size_t begin = text.rfind('\n', at) + 1;
                return text.substr(begin, end - begin);
            }
            if (int status = 0; viewer_ > 0 && waitpid(viewer_, &status, WNOHANG) == viewer_) {
                viewer_ = -1;
                if (status_of(status) == 0 && log().find(part, heard_) != std::string::npos) continue;
                break;
            }
        }
        ADD_FAILURE() << "never said: " << part << "\n" << log();
        return "";
    }

    // The image that is there now, in a file.
    std::string save(const char* key, const std::string& name) {
        hand(std::string("key ") + key);
        await("wrote " + name);
        return bytes_of(folder / name);
    }

    // What `myriad render` makes of the command line that the viewer copies.
    std::string rendered(const std::string& ending, const std::string& more = "") {
        hand("key ctrl+c");
        const std::string said = await("message: copied: myriad render");
        if (HasFailure()) return "";
        std::string command = said.substr(said.find("copied: myriad") + 14);
        command = command.substr(0, command.find(" --png view.png"));
        const std::string file = folder / ("rendered" + ending);
        EXPECT_EQ(shell("cd " + folder.path.string() + " && " MYRIAD_PROGRAM + command + " -q -o " + file + more), 0) << command;
        hand("key Escape");
        await("message gone");
        return bytes_of(file);
    }

    TempFolder folder;
    std::optional<Screen> screen_;
    pid_t viewer_ = -1;
    std::filesystem::path log_;
    std::string window_;
    size_t heard_ = 0;
};

TEST_F(view_window, shows_moves_switches_resizes_opens_and_closes) {
    start("builtin:cornell --window 520x200 --vpls 64 --samples 12");
    await("view: complete");

    // What is saved is what render makes, all layers and metadata included.
    const std::string first = save("F2", "view-0001.png");
    EXPECT_TRUE(first == rendered(".png")) << "the first image";
    EXPECT_TRUE(save("F3", "view-0001.exr") == rendered(".exr", " --aov all")) << "its layers";

    // Moving.
    hand("keydown w");
    await("view: preview");
    hand("keyup w");
    await("view: wish");
    await("view: complete");
    const std::string moved = save("F2", "view-0002.png");
    EXPECT_TRUE(moved != first) << "the camera has not moved";
    EXPECT_TRUE(moved == rendered(".png")) << "after a move";

    // Back to where the scene looks from, and by another technique, beside what there was.
    hand("key r");
    await("view: complete");
    hand("key k");
    await("view: relMSE 0.000000");
    hand("key t");
    const std::string off = await("view: relMSE");
    await("view: complete");
    EXPECT_EQ(off.find("0.000000"), std::string::npos) << "other maps, another image";
    hand("key x");
    hand("key v");
    const std::string shared = save("F2", "view-0003.png");
    EXPECT_TRUE(shared == rendered(".png")) << "by megaviews";

    // Another size; hidden and shown again.
    hand("windowsize " + window_ + " 560 240");
    const std::string larger = await("view: complete");
    EXPECT_NE(larger.find("x240 of wish"), std::string::npos) << larger;
    hand("windowunmap " + window_);
    hand("windowmap --sync " + window_);
    hand("windowfocus " + window_);

    // Files: one that is none, and one that is good.
    put(folder / "bad.glb", "this is no glTF");
    EXPECT_TRUE(drop_file(screen_->display, std::stoul(window_), folder / "bad.glb"));
    await("view: dropped");
    await("view: error: ");
    EXPECT_EQ(shell(std::string(MYRIAD_PROGRAM) + " convert builtin:cornell " + (folder / "good.glb").string()), 0);
    EXPECT_TRUE(drop_file(screen_->display, std::stoul(window_), folder / "good.glb"));
    const size_t from = heard_;
    await("view: well again");
    heard_ = from;  // either may be said first: the picture is the worker's word
    await("view: complete");
    hand("key F4");
    await("wrote view-0004.png");
    const Picture window = read_png(folder / "view-0004.png");
    EXPECT_EQ(window.width, 560u);
    EXPECT_EQ(window.height, 240u);

    hand("key ctrl+q");
    await("view: closed");
    int status = 0;
    if (viewer_ > 0) waitpid(viewer_, &status, 0);
    viewer_ = -1;
    EXPECT_EQ(status, 0);
    EXPECT_EQ(log().find("validation"), std::string::npos) << log();
    const std::string kept = bytes_of(folder / "config" / "myriad" / "view.json");
    EXPECT_NE(kept.find("good.glb"), std::string::npos) << kept;
    EXPECT_NE(kept.find("\"--visibility\": \"megaviews\""), std::string::npos) << kept;
}

TEST(view_command, needs_a_screen_and_says_so) {
    const Outcome o = myriad_program({"view"}, {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}});
    EXPECT_EQ(o.status, 3);
    EXPECT_EQ(o.error_lines(), 1) << o.err;
    EXPECT_TRUE(contains(o.err, "DISPLAY")) << o.err;
}

TEST(view_command, refuses_before_there_is_a_window) {
    for (const auto& [arguments, part] : {std::pair(Arguments{"view", "--vpls", "many"}, "--vpls 'many'"), {{"view", "builtin:cornell", "--visibility", "rays", "--coverage", "full"}, "--coverage"},
                                          {{"view", "--eye", "0,0,0"}, "--target"}, {{"view", "-o", "a.exr"}, "view"}}) {
        const Outcome o = myriad_program(arguments, {{"DISPLAY", ""}});
        EXPECT_EQ(o.status, 2) << part;
        EXPECT_TRUE(contains(o.err, part)) << o.err;
    }
}

}  // namespace
}  // namespace myriad::tools
