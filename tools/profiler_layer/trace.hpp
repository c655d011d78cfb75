// What was measured, and its two forms for reading: a trace in Chrome's JSON form, which Perfetto opens, and a table.
// One trace a process: devices and threads have tracks in it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace myriad::profiler {

// What a stretch of time was spent on.
enum class Kind : uint8_t { frame, commands, region, render_pass, command, host_frame, recording, submission };
const char* kind_name(Kind kind);

// Not locked: who shares it guards it. Times are nanoseconds of the host's steady clock.
class Trace {
public:
    // Tracks appear in the order of their `order`; asking twice for a name gives the same track.
    uint32_t track(const std::string& name, int order);
    void span(uint32_t track, Kind kind, const std::string& name, double begin_ns, double ns, uint64_t frame);
    void counter(const std::string& name, double at_ns, double value);
    // An arrow from a submission to the work that it started; both ends lie within spans.
    void arrow(uint32_t from_track, double from_ns, uint32_t to_track, double to_ns);
    // A sentence about what is not in the trace, or less exact than it might be; told once.
    void note(const std::string& text, uint64_t count = 1) { notes_[text] += count; }

    bool empty() const { return spans_.empty(); }
    std::string json() const;
    // kind,name,count,median_ms,total_ms,min_ms,max_ms: what ran on devices first, then what the host did.
    std::string csv() const;
    const std::map<std::string, uint64_t>& notes() const { return notes_; }

private:
    struct Span {
        uint32_t track, name;
        Kind kind;
        double begin_ns, ns;
        uint64_t frame;
    };
    struct Sample {
        uint32_t name;
        double at_ns, value;
    };
    struct Arrow {
        uint32_t from_track, to_track;
        double from_ns, to_ns;
    };
    struct Track {
        std::string name;
        int order;
    };
    uint32_t interned(const std::string& name);
    double origin_ns() const;

    std::vector<Track> tracks_;
    std::vector<std::string> names_;
    std::unordered_map<std::string, uint32_t> name_index_;
    std::vector<Span> spans_;
    std::vector<Sample> samples_;
    std::vector<Arrow> arrows_;
    std::map<std::string, uint64_t> notes_;
};

// Writes a file beside and renames it: a reader finds all of it, or what was there. Gives a sentence when it could not.
std::string write_whole(const std::string& path, const std::string& text);

}  // namespace myriad::profiler
