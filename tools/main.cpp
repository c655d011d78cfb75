// The program: its subcommands, and the one place where errors become messages and exit statuses (spec, section 5).
#include <CLI/CLI.hpp>

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "engine/error.hpp"
#include "tools/commands.hpp"
#include "tools/message.hpp"
#include "tools/output_file.hpp"
#include "tools/revision.hpp"

namespace myriad::tools {
namespace {

constexpr int bad_usage = 2, no_resources = 3;

int fail(int status, std::string_view message) {
    std::fflush(stdout);
    say("error", message);
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
    add_view(app);
    add_reference(app);
    add_compare(app);
    add_convert(app);
    add_bench(app);
    add_info(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return parse_failed(app, e);
    }
    if (app.get_subcommands().empty()) {
        std::fputs(app.help().c_str(), stdout);
        return fail(bad_usage, "no subcommand is given; choose one of those above");
    }
    if (std::fflush(stdout) != 0) throw InputError("cannot write to standard output; check where it goes");
    return 0;
}

constexpr std::string_view no_memory = "the machine's memory is used up; lower --size, --vpls or --samples, or give a smaller scene";

// For what is thrown where nothing may be, as by JSON's destructor, which takes memory.
[[noreturn]] void terminated() {
    remove_temporaries();
    try {
        throw;
    } catch (const std::bad_alloc&) {
        say("error", no_memory);
        _exit(no_resources);
    } catch (...) {
    }
    std::abort();
}

// Takes no memory itself where an error may mean that there is none.
int run_and_report(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const Error& e) {
        return fail(e.exit_status(), e.what());
    } catch (const std::bad_alloc&) {
        return fail(no_resources, no_memory);
    } catch (const std::exception& e) {
        char text[1024];
        std::snprintf(text, sizeof text, "something unforeseen went wrong (%s); please report it", e.what());
        return fail(no_resources, text);
    }
}

}  // namespace
}  // namespace myriad::tools

int main(int argc, char** argv) {
    myriad::tools::remove_temporaries_on_signal();
    std::set_terminate(myriad::tools::terminated);
    return myriad::tools::run_and_report(argc, argv);
}
