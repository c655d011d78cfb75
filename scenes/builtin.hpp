// The built-in scenes: generated in code, deterministic by seed, no download. One file each, under builtin/.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace myriad::scenes {

// What a user may write after `?` in builtin:NAME?key=value. The default decides the type: a decimal number makes the
// option a number within [least, most]; anything else makes it a word, one of `choices`.
struct BuiltinOption {
    std::string key, fallback;
    std::vector<std::string> choices;
    float least = 0, most = 0;
};

// Options after parsing: every key of the scene is present and valid, so that generators just look up.
class BuiltinOptions {
public:
    BuiltinOptions(const std::string& scene, const std::vector<BuiltinOption>& known, const std::string& query);
    float number(const std::string& key) const;
    const std::string& word(const std::string& key) const { return values_.at(key); }

private:
    std::map<std::string, std::string> values_;
};

struct Builtin {
    std::string name, summary;
    std::vector<BuiltinOption> options;
    Scene (*make)(const BuiltinOptions& options, uint32_t seed);
};

const std::vector<Builtin>& builtins();

// `query`: what follows "builtin:", for example "atrium?detail=2". Throws InputError naming what exists.
Scene load_builtin(const std::string& query, uint32_t seed);

Scene make_atrium(const BuiltinOptions& options, uint32_t seed);
Scene make_cathedral(const BuiltinOptions& options, uint32_t seed);
Scene make_cornell(const BuiltinOptions& options, uint32_t seed);
Scene make_hairball(const BuiltinOptions& options, uint32_t seed);
Scene make_particles(const BuiltinOptions& options, uint32_t seed);
Scene make_teatime(const BuiltinOptions& options, uint32_t seed);

}  // namespace myriad::scenes
