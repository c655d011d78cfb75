// `myriad info`: the Vulkan devices there are, what Myriad can use of them, and which one it would take.
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "engine/device.hpp"
#include "tools/commands.hpp"

namespace myriad::tools {
namespace {

using engine::Device;
using engine::DeviceInfo;

struct Options {
    std::string device;
    bool json = false;
};

std::string api(const DeviceInfo& d) {
    return std::to_string(d.api_major) + "." + std::to_string(d.api_minor) + "." + std::to_string(d.api_patch);
}

// Asks the engine, which opens what it picks. Of twins it takes the first, unless an index says otherwise.
size_t picked(const std::vector<DeviceInfo>& all, const std::string& select) {
    const Device device({.select = select, .validation = false, .memory_limit = 0});
    const bool index = !select.empty() && select.find_first_not_of("0123456789") == std::string::npos;
    if (index) return std::stoul(select);
    for (size_t i = 0; i < all.size(); ++i)
        if (all[i].usable() && all[i].name == device.info().name && all[i].driver_version == device.info().driver_version) return i;
    return all.size();
}

nlohmann::ordered_json to_json(const DeviceInfo& d, size_t index, bool picked) {
    return {{"index", index}, {"name", d.name}, {"driver", d.driver}, {"driver_version", d.driver_version}, {"api", api(d)},
            {"type", d.type}, {"heap_bytes", d.heap_bytes}, {"usable", d.usable()}, {"picked", picked}, {"used", d.used},
            {"missing", d.missing}, {"degraded", d.degraded}, {"limits", d.limits}};
}

void print_list(const char* title, const std::vector<std::string>& items) {
    for (size_t i = 0; i < items.size(); ++i) std::printf("  %-9s %s\n", i ? "" : title, items[i].c_str());
}

void print(const DeviceInfo& d, size_t index, bool picked) {
    std::printf("%zu %s%s\n", index, d.name.c_str(), picked ? "   <- used" : d.usable() ? "" : "   (cannot be used)");
    std::printf("  %-9s %s, %s\n", "driver", d.driver.c_str(), d.driver_version.c_str());
    std::printf("  %-9s %s\n  %-9s %s\n", "Vulkan", api(d).c_str(), "type", d.type.c_str());
    std::printf("  %-9s %llu MiB\n", "heap", static_cast<unsigned long long>(d.heap_bytes >> 20));
    print_list("used", d.used);
    print_list("missing", d.missing);
    print_list("degraded", d.degraded);
    const char* title = "limits";
    for (const auto& [name, value] : d.limits) {
        std::printf("  %-9s %-30s %llu\n", title, name.c_str(), static_cast<unsigned long long>(value));
        title = "";
    }
}

// What there is gets printed also when nothing of it can be used: then the reason follows as the error.
void run(const Options& options) {
    const std::vector<DeviceInfo> all = Device::enumerate();
    size_t chosen = all.size();
    std::unique_ptr<DeviceError> refused;
    try {
        chosen = picked(all, options.device);
    } catch (const DeviceError& e) {
        if (all.empty() || !options.device.empty()) throw;
        refused = std::make_unique<DeviceError>(e);
    }
    nlohmann::ordered_json devices = nlohmann::ordered_json::array();
    for (size_t i = 0; i < all.size(); ++i) {
        if (options.json) devices.push_back(to_json(all[i], i, i == chosen));
        else print(all[i], i, i == chosen);
    }
    if (options.json) {
        const nlohmann::ordered_json json = {{"devices", devices}};
        std::printf("%s\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    }
    if (refused) throw *refused;
}

}  // namespace

void add_info(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("info", "Vulkan devices: features used and missing, limits, and which one is taken");
    command->add_flag("--json", options->json, "print one JSON object");
    command->add_option("--device", options->device, "the device that would be asked for: part of a name, or an index")
        ->type_name("NAME|INDEX");
    command->callback([options] { run(*options); });
}

}  // namespace myriad::tools
