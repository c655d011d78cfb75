// `myriad view [SCENE]`: a scene in a window.
#include <CLI/CLI.hpp>

#include <memory>

#include "tools/commands.hpp"
#include "tools/view/app.hpp"

namespace myriad::tools {
namespace {

const char* const footer = "What is given here can be changed in the window; see myriad render -h. F1 lists keys; a file that is dropped on the window is opened. Settings are\n"
                           "kept in ~/.config/myriad/view.json.\n\n";

}  // namespace

void add_view(CLI::App& app) {
    CLI::App* command = app.add_subcommand("view", "See a scene in a window, walk through it, change how it is rendered");
    auto options = std::make_shared<view::ViewOptions>();
    command->add_option("SCENE", options->scene, "as for render; builtin:atrium unless given")->type_name("");
    add_parsed(*command, "--window", "WxH", "", "pixels of the window; unless given, as last time", [options](const std::string& text) {
        const auto [width, height] = parse_size("--window", text);
        options->width = int(width), options->height = int(height);
    });
    command->add_flag("--fresh", options->fresh, "begin with nothing remembered, and keep nothing");
    command->add_flag("--verbose", options->verbose, "say on stderr what happens, a line each");
    for (const auto& [name, kind] : view::option_kinds())
        add_parsed(*command, name, kind.type, kind.fallback, kind.help, [options, name = name](const std::string& text) { options->texts[name] = text; });
    command->footer(footer + builtin_scenes());
    command->callback([options] {
        view::read(options->scene.empty() ? "builtin:atrium" : options->scene, options->texts);  // refused before there is a window
        view::run(*options);
    });
}

}  // namespace myriad::tools
