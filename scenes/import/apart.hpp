// A reader in a process of its own: for libraries that were not made for hostile files.
//
// Whatever the library does with a bad file (crash, loop, ask for all the memory there is), it does there, within limits,
// and here it becomes one sentence. What the reader found comes back as a .glb in memory and goes through our own loader,
// which trusts nothing.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "scenes/import/import.hpp"

namespace myriad::scenes::importing {

struct ApartLimits {
    uint64_t memory = 2ull << 30;  // bytes of address space beyond what this process has
    uint64_t seconds = 10;         // of processor time

    // What reading so many bytes may honestly take; never more memory than the machine has.
    static ApartLimits for_file(uint64_t bytes);
};

// Called apart, when the reader has opened one more file: raises the limits by what so many bytes may honestly take.
void earn_limits(uint64_t bytes);

// Runs `read` apart and returns what it returned, tidied with the crease that `options` or the reader say. InputErrors of
// the reader are thrown on; `path` begins all other messages. The process is a fork: call it from one thread.
Imported read_apart(const std::string& path, const ApartLimits& limits, const ImportOptions& options, const std::function<Imported()>& read);

}  // namespace myriad::scenes::importing
