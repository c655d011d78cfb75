#include "tools/render_options.hpp"

#include <cstring>
#include <filesystem>
#include <limits>
#include <set>
#include <tuple>

#include "scenes/scene.hpp"
#include "tools/capture.hpp"
#include "tools/output_file.hpp"

namespace myriad::tools {
namespace {

void set_output(RenderOptions& options, const std::string& path) {
    if (path.ends_with(".exr")) return void(options.exr = path);
    if (!path.ends_with(".png")) throw InputError("-o '" + path + "': unknown format; name an .exr or a .png file");
    if (!options.png.empty()) throw InputError("-o '" + path + "': --png names a picture already; give an .exr file here");
    options.png = path;
}

void set_picture(RenderOptions& options, const std::string& path) {
    if (!path.ends_with(".png")) throw InputError("--png '" + path + "': name a .png file");
    if (!options.png.empty()) throw InputError("--png '" + path + "': -o names a picture already; give one of them");
    options.png = path;
}

void add_outputs(CLI::App& command, RenderOptions& o) {
    command.add_option_function<std::string>(
        "-o,--output", [&o](const std::string& path) { set_output(o, path); },
        "image: .exr, linear radiance, or .png as for --png; this or --png is needed")->type_name("FILE");
    command.add_option_function<std::string>(
        "--png", [&o](const std::string& path) { set_picture(o, path); },
        "picture to look at: exposed, tone-mapped, 8-bit sRGB")->type_name("FILE");
    add_parsed(command, "--exposure", "E|auto", "auto", "factor on radiance before the tone curve of the picture; auto: brings the\n"
               "geometric mean of the luminance of all pixels that are not black to middle grey", [&o](const std::string& text) {
        o.exposure.reset();
        if (text != "auto") o.exposure = parse_number("--exposure", text, 1e-30f, 1e30f);
    });
    add_parsed(command, "--aov", "LIST", "", "further layers of the EXR: all, or some of " + CLI::detail::join(layer_names(), ",") + ";\n"
               "specular: of indirect, what glossy lobes reflect; N: shading normal, P: position (m), Z: depth along the camera's axis (m), all 0 where nothing is seen", [&o](const std::string& text) {
        o.layers = parse_list("--aov", text, layer_names());
    });
    command.add_flag("--float", o.full_floats, "colours of the EXR as 32-bit floats instead of halves (P and Z always are)");
    command.add_option("--stats", o.stats, "write sizes, settings, times and counters as JSON")->type_name("FILE");
    command.add_option("--trace", o.trace, "write a time line of CPU and GPU, to open in ui.perfetto.dev")->type_name("FILE");
    add_parsed(command, "--capture-frame", "N", "", "where RenderDoc is attached (renderdoccmd capture myriad render …): captures the making of image N, from 0, of --repeat\n"
               "or --frames", [&o](const std::string& text) { o.capture_frame = parse_number("--capture-frame", text, 0u, ~0u); });
    command.add_flag("-q,--quiet", o.quiet, "no table and no progress");
}

void add_primary(CLI::App& command, RenderOptions& o) {
    add_choice(command, "--primary", o.frame.primary, primaries(),
               "how what the camera sees is found: a ray a pixel, exact; or points, drawn from the camera's\ncut through the tree of --samples");
    add_parsed(command, "--primary-pixels", "C", show_number(o.frame.primary_pixels), "of points: largest diameter, in pixels, of a node that is drawn and not opened; leaves are\n"
               "drawn as large as they are", [&o](const std::string& text) {
        o.primary_pixels = o.frame.primary_pixels = parse_number("--primary-pixels", text, 1e-3f, 1e6f);
    });
}

void add_technique(CLI::App& command, RenderOptions& o) {
    passes::FrameSettings& s = o.frame;
    add_choice(command, "--visibility", s.visibility, visibilities(),
               "whether a VPL sees a pixel: by its map, drawn from its cut through the scene\n(manylods), of both trees, of the scene and of the VPLs, with what is alike for many drawn once (megaviews), of all triangles (brute) or of few points (ism: imperfect shadow maps); by exact rays, the reference; or taken for granted");
    add_choice(command, "--point-lights", s.point_lights, point_lightings(),
               "how the scene's point lights light what is seen: by a shadow ray a pixel and light (direct), or as VPLs do, by --visibility\n"
               "and --gather (gather), which auto does with more than " + std::to_string(passes::most_direct_points) + " of them, unless visibility is none");
    add_whole(command, "--vpls", s.vpls, 0, 1u << 24, "virtual point lights at most; 0: no indirect light");
    add_whole(command, "--bounces", s.bounces, 0, 64, "diffuse reflections of light before what the camera sees");
    add_parsed(command, "--gather", "all|subset:K|culled:K|tree:K", show_gather(s), "VPLs that each pixel gathers: all; or about K, a different subset for each pixel\n"
               "of a block; or K of those that may light its tile of pixels at all (culled), or K by what they may bring there (tree)", [&s](const std::string& text) {
        parse_gather("--gather", text, s);
    });
    add_parsed(command, "--gather-distance", "METRES", "", "of culled: VPLs further away bring nothing", [&o](const std::string& text) {
        o.gather_distance = true;
        o.frame.gather_distance = parse_number("--gather-distance", text, 1e-12f, 1e12f);
    });
    add_choice(command, "--filter", s.filter, {{"on", true}, {"off", false}}, "average the subsets of blocks of pixels, across no edge");
    add_choice(command, "--brdf", s.brdf, brdfs(), "how what is seen reflects: as glTF's metallic-roughness materials say, or their diffuse part\nalone, metals black. VPLs are diffuse in either case");
    add_number(command, "--vpl-bound", s.vpl_bound, 1e-30f, 1e30f, "bound of the geometry term, 1/m^2; unless given pi * VPLs / area,\nwith --compensate of " + std::to_string(passes::compensated_vpls) + " VPLs at most");
    add_whole(command, "--compensate", s.compensate, 0, compensate_most_rays, "short rays a pixel that give back, to diffuse surfaces, the light that the bound cuts off; 0: it stays lost");
    add_whole(command, "--map-size", s.maps.map_size, 2, 1024, "texels a side of each half of a map");
    add_number(command, "--epsilon", s.maps.epsilon, 1e-3f, 1e6f, "largest diameter of a node in the cut, in texels of its map");
    add_choice(command, "--coverage", s.maps.coverage, coverages(), "what a node covers that is smaller than a texel: the texels whose middles it covers (exact), all of the texel that it is in,\n"
               "as points are drawn (full: hides too much), or a texel with the probability of its share of it (stochastic)");
    add_choice(command, "--fusion", s.maps.asks, fusions(), "megaviews: each view's map gets all that it shares with others (views), or each look-up asks\nthe shared map as well (queries): the same image");
    add_whole(command, "--ism-points", s.maps.ism.points, 1, 1u << 24, "points that ism draws into each map, of the --samples there are");
    add_number(command, "--bias", s.bias, 0, 1e6f, "receiver bias of maps, in half diagonals of a texel");
    add_parsed(command, "--update", "basic|incremental|lazy[:q]", show_update(s.maps),
               "where a frame's cuts start: at the root; at the cuts of the frame before, which gives\nthe same cuts; or there, going down q edges at most (1): cuts may lag", [&s](const std::string& text) {
        parse_update("--update", text, s.maps);
    });
    add_whole(command, "--samples", s.log2_samples, 0, 28, "2^N points on the surface, the leaves of the tree that is cut");
    add_choice(command, "--arity", s.maps.arity, arities(), "children of a node of that tree");
    add_parsed(command, "--tree", "bsh|svo[:D]", show_tree(s), "the tree that is cut: over --samples, or, for --visibility megaviews, of all cells that triangles meet, D levels\nbelow the root (1 to 12, unless given 9), built anew when something moves",
               [&s](const std::string& text) { s.octree_levels = parse_tree("--tree", text); });
    add_choice(command, "--append", s.maps.append, append_modes(), "how lists are appended to; images are the same");
    add_whole(command, "--seed", s.seed, 0, ~0u, "of the VPLs and the points; the scene does not depend on it");
}

void add_movement(CLI::App& command, RenderOptions& o) {
    add_moment(command, o);
    add_parsed(command, "--frames", "A-B", "", "frames A to B, frame i at i / fps seconds; FILE.exr becomes FILE.0000.exr and so on,\n"
               "DIR/%04d.exr becomes DIR/0000.exr (%0Nd: N digits at least; once, in the name of the file), of -o, --png and --stats,\n"
               "which is one file for all frames otherwise; folders must be there",
               [&o](const std::string& text) { o.frames = parse_frames("--frames", text); });
    add_parsed(command, "--fps", "N", "24", "frames a second, of --frames", [&o](const std::string& text) { o.fps = parse_rate("--fps", text); });
    add_parsed(command, "--rebuild", "off|GROWTH", "off", "builds the tree of --samples anew when deformation has made its spheres that many times as large as they were\n"
               "(tree_growth in --stats), 0: whenever something moves; else it is refitted, which is cheaper but lets cuts grow",
               [&o](const std::string& text) {
                   o.rebuild = true;
                   o.frame.rebuild = text == "off" ? std::numeric_limits<float>::infinity() : parse_number("--rebuild", text, 0, 1e6f);
               });
}

const char* const footer =
    "Lengths are in metres. glTF's photometric units are taken as radiometric 1:1: point and spot intensity in W/sr,\n"
    "directional irradiance in W/m^2; emission is radiance. Light that comes straight from emitting surfaces counts as\n"
    "indirect in the layers, for it is gathered from VPLs on them. Results are the same for the same seed and device.\n"
    "Exit status: 0 done; 2 bad usage or bad input; 3 no usable device, or out of memory.\n"
    "\n";

}  // namespace

const Choices<passes::Visibility>& visibilities() {
    using passes::Visibility;
    static const Choices<Visibility> choices = {{"manylods", Visibility::manylods}, {"megaviews", Visibility::megaviews}, {"brute", Visibility::brute}, {"ism", Visibility::ism}, {"rays", Visibility::rays}, {"none", Visibility::none}};
    return choices;
}

const Choices<passes::PointLighting>& point_lightings() {
    using passes::PointLighting;
    static const Choices<PointLighting> choices = {{"auto", PointLighting::automatic}, {"direct", PointLighting::direct}, {"gather", PointLighting::gather}};
    return choices;
}

const Choices<passes::Primary>& primaries() {
    using passes::Primary;
    static const Choices<Primary> choices = {{"rays", Primary::rays}, {"points", Primary::points}};
    return choices;
}

const Choices<passes::Brdf>& brdfs() {
    using passes::Brdf;
    static const Choices<Brdf> choices = {{"gltf", Brdf::gltf}, {"diffuse", Brdf::diffuse}};
    return choices;
}

const Choices<bool>& fusions() {
    static const Choices<bool> all = {{"views", false}, {"queries", true}};
    return all;
}

const Choices<uint32_t>& coverages() {
    static const Choices<uint32_t> all = {{"exact", coverage_exact}, {"full", coverage_full}, {"stochastic", coverage_stochastic}};
    return all;
}

const Choices<compute::AppendMode>& append_modes() {
    using compute::AppendMode;
    static const Choices<AppendMode> choices = {{"scan", AppendMode::scan}, {"atomic", AppendMode::atomic}};
    return choices;
}

std::string show_update(const passes::MapSettings& maps) {
    using passes::CutUpdate;
    return maps.update == CutUpdate::basic ? "basic" : maps.update == CutUpdate::incremental ? "incremental" : "lazy:" + std::to_string(maps.lazy_edges);
}

void parse_update(const std::string& option, const std::string& text, passes::MapSettings& maps) {
    using passes::CutUpdate;
    constexpr std::string_view prefix = "lazy:";
    maps.lazy_edges = 1;
    if (text.starts_with(prefix)) maps.lazy_edges = parse_whole(option, text.substr(prefix.size()), 1, 30);
    else if (text != "basic" && text != "incremental" && text != "lazy")
        throw InputError(option + " '" + text + "': give basic, incremental, lazy, or lazy:q with a whole number q from 1 on");
    maps.update = text == "basic" ? CutUpdate::basic : text == "incremental" ? CutUpdate::incremental : CutUpdate::lazy;
}

std::string show_gather(const passes::FrameSettings& s) {
    if (s.subset == 0) return "all";
    const char* names[] = {"subset:", "culled:", "tree:"};
    return names[int(s.gather)] + std::to_string(s.subset);
}

void parse_gather(const std::string& option, const std::string& text, passes::FrameSettings& s) {
    using passes::GatherMethod;
    if (text == "all") return void((s.gather = GatherMethod::subset, s.subset = 0));
    for (const auto& [prefix, method, most] : {std::tuple("subset:", GatherMethod::subset, ~0u), {"culled:", GatherMethod::culled, pick_most}, {"tree:", GatherMethod::tree, pick_most}})
        if (text.starts_with(prefix)) {
            s.subset = uint32_t(parse_whole(option + " " + std::string(prefix, std::strlen(prefix) - 1), text.substr(std::strlen(prefix)), 1, most));
            return void(s.gather = method);
        }
    throw InputError(option + " '" + text + "': give all, or subset:K, culled:K or tree:K with a whole number K from 1 on, such as subset:256");
}

std::string show_tree(const passes::FrameSettings& settings) { return settings.octree_levels ? "svo:" + std::to_string(settings.octree_levels) : "bsh"; }

uint32_t parse_tree(const std::string& option, const std::string& text) {
    constexpr std::string_view prefix = "svo:";
    if (text == "bsh") return 0;
    if (text == "svo") return 9;
    if (text.starts_with(prefix)) return uint32_t(parse_whole(option, text.substr(prefix.size()), 1, compute::Svo::most_levels));
    throw InputError(option + " '" + text + "': give bsh, svo, or svo:D with a number of levels D from 1 to " + std::to_string(compute::Svo::most_levels));
}

const Choices<uint32_t>& arities() {
    static const Choices<uint32_t> choices = {{"2", 2}, {"4", 4}, {"8", 8}};
    return choices;
}

const Choices<scenes::Sharing>& sharings() {
    using scenes::Sharing;
    static const Choices<Sharing> choices = {{"auto", Sharing::automatic}, {"shared", Sharing::always}, {"flat", Sharing::never}};
    return choices;
}

const std::vector<std::string>& layer_names() {
    static const std::vector<std::string> names = {"direct", "indirect", "specular", "emission", "albedo", "N", "P", "Z"};
    return names;
}

std::shared_ptr<RenderOptions> add_render_options(CLI::App& command) {
    auto shared = std::make_shared<RenderOptions>();
    RenderOptions& o = *shared;
    add_scene(command, o);
    add_outputs(command, o);
    add_parsed(command, "--size", "WxH", std::to_string(o.frame.width) + "x" + std::to_string(o.frame.height), "pixels",
               [&o](const std::string& text) { std::tie(o.frame.width, o.frame.height) = parse_size("--size", text); });
    add_camera(command, o);
    add_movement(command, o);
    add_sky(command, o);
    add_environment(command, o);
    add_parsed(command, "--env-lights", "N", std::to_string(scenes::default_environment_lights), "directional lights that stand for it,\neach with its map; more of them where it is brighter",
               [&o](const std::string& text) { o.environment_lights = uint32_t(parse_whole("--env-lights", text, 1, scenes::most_environment_lights)); });
    add_choice(command, "--instances", o.instances, sharings(),
               "meshes with several instances: stored once where that saves 16 MiB and a quarter of\nthe scene, wherever it can be, or written out; memory and time differ, the image does not");
    add_primary(command, o);
    add_technique(command, o);
    add_parsed(command, "--memory-limit", "MiB", "", "for all buffers on the device; unless given, what it has", [&o](const std::string& text) {
        o.device.memory_limit = parse_whole("--memory-limit", text, 1, uint64_t(1) << 30) << 20;
    });
    add_parsed(command, "--cache", "FOLDER|off", o.cache.empty() ? "off" : o.cache.string(), "where ray trees and samples are kept between runs, 4 GiB at most; safe to delete",
               [&o](const std::string& text) { o.cache = text == "off" ? "" : text; });
    command.add_option("--device", o.device.select, "part of a name, or an index, as myriad info lists them")->type_name("NAME|INDEX");
    add_whole(command, "--repeat", o.repeat, 1, 100000, "frames to render, all the same; times are then medians");
    command.footer(footer + builtin_scenes());
    return shared;
}

namespace {

constexpr size_t conversion_size = 4;  // of "%04d"

// Where the %0Nd begins, in the name of the file; npos: nowhere.
size_t find_number(const std::string& path) {
    for (size_t at = path.rfind('/') + 1; at + conversion_size <= path.size(); ++at)  // npos + 1 is 0
        if (path[at] == '%' && path[at + 1] == '0' && path[at + 2] >= '1' && path[at + 2] <= '9' && path[at + 3] == 'd') return at;
    return std::string::npos;
}

void check_numbered(const std::string& option, const std::string& path, bool frames) {
    const size_t at = find_number(path), last = path.rfind('%');
    if (at != std::string::npos && !frames)
        throw InputError(option + " '" + path + "': the name has a place for the number of a frame, and one image is asked for; "
                         "give --frames A-B, or a plain name");
    if (!frames || last == std::string::npos || last < path.rfind('/') + 1) return;
    if (at != last || path.find('%', path.rfind('/') + 1) != at)
        throw InputError(option + " '" + path + "': a name of frames may have one %0Nd, N from 1 to 9, and no other %; write it like frame%04d.exr");
}

}  // namespace

bool has_number(const std::string& path) { return find_number(path) != std::string::npos; }

std::string numbered(const std::string& path, std::optional<uint32_t> number) {
    if (!number || path.empty()) return path;
    const std::string digits = std::to_string(*number);
    const auto padded = [&](size_t least) { return std::string(digits.size() < least ? least - digits.size() : 0, '0') + digits; };
    if (const size_t at = find_number(path); at != std::string::npos)
        return path.substr(0, at) + padded(size_t(path[at + 2] - '0')) + path.substr(at + conversion_size);
    const size_t ending = path.rfind('.');
    return path.substr(0, ending) + "." + padded(4) + path.substr(ending);
}

void check_choices(const RenderOptions& o) {
    if (o.time && o.frames) throw InputError("--time and --frames both say which moment to render; give one of them");
    if (o.fps && !o.frames) throw InputError("--fps needs frames to be the rate of; name them with --frames");
    if (o.frames && o.repeat > 1) throw InputError("--frames renders a moment each, --repeat one moment again and again; give one of them");
    check_scene(o, o.frames.has_value());
    if (o.rebuild && !o.moves())
        throw InputError("--rebuild is about a scene that moves; play a clip, with --frames, --time or --animation");
    if (o.frame.visibility == passes::Visibility::megaviews && o.frame.maps.update != passes::CutUpdate::basic)
        throw InputError("--update " + show_update(o.frame.maps) + " carries the cuts of manylods from frame to frame; megaviews has none, its trees are walked anew");
    if (o.frame.maps.asks && (o.frame.visibility != passes::Visibility::megaviews || o.frame.gather != passes::GatherMethod::subset))
        throw InputError("--fusion queries is about maps that views share, looked up by --gather all and subset; give --visibility megaviews and such a gather, or leave it out");
    if (o.frame.maps.coverage != coverage_exact && o.frame.visibility != passes::Visibility::manylods && o.frame.visibility != passes::Visibility::megaviews)
        throw InputError("--coverage " + choice_name(coverages(), o.frame.maps.coverage) + " is about nodes that are drawn, and --visibility " +
                         choice_name(visibilities(), o.frame.visibility) + " draws none; give manylods or megaviews");
    if (o.frame.compensate && (o.frame.vpls == 0 || o.frame.visibility == passes::Visibility::none))
        throw InputError(std::string("--compensate gives back what VPLs lose, by rays to what is near, and ") +
                         (o.frame.vpls == 0 ? "--vpls 0 has none; leave one of them out" : "--visibility none knows nothing in the way; give another --visibility"));
    if (o.gather_distance && o.frame.gather != passes::GatherMethod::culled)
        throw InputError("--gather-distance is about culled, and --gather " + show_gather(o.frame) + " has no cut-off; give --gather culled:K with it");
    if (o.frame.gather != passes::GatherMethod::subset && o.frame.maps.update != passes::CutUpdate::basic)
        throw InputError("--update " + show_update(o.frame.maps) + " needs VPLs in the same places in every frame, and --gather " + show_gather(o.frame) +
                         " takes them along a curve; give --update basic, or another --gather");
    if (o.frame.octree_levels && o.frame.visibility != passes::Visibility::megaviews)
        throw InputError("--tree svo is walked by megaviews, and --visibility " + choice_name(visibilities(), o.frame.visibility) + " is asked for; give --visibility megaviews with it");
    if (o.frame.octree_levels && !o.environment.file.empty())
        throw InputError("--tree svo draws no maps for the lights of an environment; give --tree bsh with --env");
    if (o.primary_pixels && o.frame.primary != passes::Primary::points)
        throw InputError("--primary-pixels is about points, and rays have no size; give --primary points with it");
    if (o.environment.file.empty() && o.environment_lights)
        throw InputError("--env-lights is about an environment, and there is none; name one with --env FILE");
    if (!o.environment.file.empty() && (o.frame.visibility == passes::Visibility::brute || o.frame.visibility == passes::Visibility::ism))
        throw InputError("--visibility " + choice_name(visibilities(), o.frame.visibility) +
                         " draws no maps for the lights of an environment; give manylods, rays or none with --env");
}

void check_outputs(const RenderOptions& o) {
    if (o.exr.empty() && o.png.empty()) throw InputError("no output is given; name one with -o FILE.exr or --png FILE.png");
    if (o.exr.empty() && !o.layers.empty()) throw InputError("--aov needs an EXR to put the layers in; name one with -o FILE.exr");
    if (o.png.empty() && o.exposure) throw InputError("--exposure needs a picture to apply to; name one with --png FILE.png");
    check_choices(o);
    if (o.capture_frame && !renderdoc_attached())
        throw InputError("--capture-frame is for RenderDoc, which is not attached; start the program with renderdoccmd capture, or leave the option out");
    const uint32_t images = o.frames ? o.frames->second - o.frames->first + 1 : o.repeat;
    if (o.capture_frame && *o.capture_frame >= images)
        throw InputError("--capture-frame " + std::to_string(*o.capture_frame) + ": images are numbered from 0, and the last is " +
                         std::to_string(images - 1) + "; give --repeat, or a lower number");
    for (const auto& [option, path] : {std::pair("-o", o.exr), {"--png", o.png}}) check_numbered(option, path, o.frames.has_value());
    if (has_number(o.stats)) check_numbered("--stats", o.stats, o.frames.has_value());
    if (has_number(o.trace)) throw InputError("--trace '" + o.trace + "': a time line is one for all frames; give a plain name");
    std::optional<uint32_t> first;
    if (o.frames) first = o.frames->first;
    std::set<std::filesystem::path> seen;
    const std::string stats = has_number(o.stats) ? numbered(o.stats, first) : o.stats;
    for (const std::string& path : {numbered(o.exr, first), numbered(o.png, first), stats, o.trace}) {
        if (path.empty()) continue;
        require_writable(path);
        if (!seen.insert(std::filesystem::absolute(path).lexically_normal()).second)
            throw InputError("'" + path + "' is asked for twice; give each output its own name");
    }
}

}  // namespace myriad::tools
