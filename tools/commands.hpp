// The subcommands of `myriad`, a file each: add_NAME registers the command, its options and what it does.
//
//   int main(int argc, char** argv) {
//       CLI::App app; add_render(app); …
//       try { app.parse(argc, argv); }                           // runs the command, as a callback of its subcommand
//       catch (const CLI::ParseError& e) { … app.exit(e) … }     // bad usage: 2; -h is one too, with exit code 0
//       catch (const myriad::Error& e) { … e.exit_status(); }    // 1, 2 or 3, with its message on stderr
//   }
//
// A command that returns has succeeded. There is one way to fail: throw an Error, whose kind is the exit status; a check
// that did not hold is an Error of kind check_failed, thrown after the results are printed.
#pragma once

namespace CLI {
class App;
}

namespace myriad::tools {

void add_render(CLI::App& app);
void add_reference(CLI::App& app);
void add_view(CLI::App& app);
void add_bench(CLI::App& app);
void add_compare(CLI::App& app);
void add_info(CLI::App& app);
void add_convert(CLI::App& app);

}  // namespace myriad::tools
