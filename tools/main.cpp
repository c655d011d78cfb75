// The program: its subcommands, and the one place where errors become messages and exit statuses (spec, section 5).
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <new>
#include <string>

#include "engine/error.hpp"
#include "tools/commands.hpp"
#include "tools/output_file.hpp"
#include "tools/revision.hpp"

namespace myriad::tools {
namespace {

constexpr int bad_usage = 2, no_resources = 3;

// One sentence on one line, whatever file names or libraries put into it.
int fail(int status, std::string message) {
    std::ranges::replace_if(message, [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
    while (message.ends_with('.') || message.ends_with(' ')) message.pop_back();
    std::fflush(stdout);
    std::fprintf(stderr, "error: %s\n", message.c_str());
    return status;
}

int parse_failed(const CLI::App& app, const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // -h and --version: prints them
    const auto commands = app.get_subcommands();
    const std::string help = "myriad " + (commands.empty() ? "" : commands.front()->get_name() + " ") + "-h";
    std::string what = e.what();
    if (const size_t at = what.find(": At Most 1"); at != std::string::npos) what = what.substr(0, at) + " is given more than once";
    return fail(bad_usage, what + "; see " + help);
}

int run(int argc, char** argv) {
    CLI::App app("Myriad renders many views of one scene at once on a Vulkan device, and lights images with them.", "myriad");
    app.set_version_flag("--version", std::string("myriad ") + version + " (" + git_revision + ")");
    app.require_subcommand(0, 1);
    add_render(app);
    add_compare(app);
    add_convert(app);
    add_bench(app);
    add_info(app);
    try {
        app.parse(argc, argv);
        if (app.get_subcommands().empty()) {
            std::fputs(app.help().c_str(), stdout);
            return fail(bad_usage, "no subcommand is given; choose one of those above");
        }
        if (std::fflush(stdout) != 0) throw InputError("cannot write to standard output; check where it goes");
        return 0;
    } catch (const CLI::ParseError& e) {
        return parse_failed(app, e);
    } catch (const Error& e) {
        return fail(e.exit_status(), e.what());
    } catch (const std::bad_alloc&) {
        return fail(no_resources, "the machine's memory is used up; lower --size, --vpls or --samples, or give a smaller scene");
    } catch (const std::exception& e) {
        return fail(no_resources, std::string("something unforeseen went wrong (") + e.what() + "); please report it");
    }
}

}  // namespace
}  // namespace myriad::tools

int main(int argc, char** argv) {
    myriad::tools::remove_temporaries_on_signal();
    return myriad::tools::run(argc, argv);
}
