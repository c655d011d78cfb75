#include "engine/digest.hpp"

#include <elf.h>
#include <link.h>
#include <openssl/evp.h>

#include <cassert>
#include <cstring>
#include <stdexcept>

#include "engine/parallel.hpp"

namespace myriad::engine {
namespace {

constexpr size_t piece = 1 << 20;

Digest sha256(Bytes bytes) {
    Digest result;
    if (EVP_Digest(bytes.data(), bytes.size(), result.data(), nullptr, EVP_sha256(), nullptr) != 1)
        throw std::runtime_error("libcrypto has no SHA-256");  // a policy can forbid it; then nothing is cached
    return result;
}

// The first note of the kind in a segment of notes: name "GNU", type build id.
Bytes build_id_of(Bytes notes) {
    while (notes.size() >= sizeof(ElfW(Nhdr))) {
        ElfW(Nhdr) note;
        std::memcpy(&note, notes.data(), sizeof note);
        const auto padded = [](size_t size) { return (size + 3) / 4 * 4; };
        const size_t name = sizeof note, content = name + padded(note.n_namesz), end = content + padded(note.n_descsz);
        if (end > notes.size()) break;
        if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 && std::memcmp(&notes[name], "GNU", 4) == 0)
            return notes.subspan(content, note.n_descsz);
        notes = notes.subspan(end);
    }
    return {};
}

}  // namespace

Digest digest(std::span<const Bytes> parts, uint32_t threads) {
    std::vector<Bytes> pieces;
    std::vector<uint64_t> lengths;
    for (const Bytes part : parts) {
        lengths.push_back(part.size());
        for (size_t at = 0; at < part.size(); at += piece) pieces.push_back(part.subspan(at, std::min(piece, part.size() - at)));
    }
    std::vector<Digest> digests(pieces.size() + 1);
    parallel_pieces(pieces.size(), 1, [&](size_t i, size_t) { digests[i] = sha256(pieces[i]); }, threads);
    digests.back() = sha256(std::as_bytes(std::span(lengths)));
    return sha256(std::as_bytes(std::span(digests)));
}

std::string hex(const Digest& digest) {
    std::string text;
    for (const uint8_t byte : digest)
        for (const int nibble : {byte >> 4, byte & 15}) text += "0123456789abcdef"[nibble];
    return text;
}

Bytes program_id() {
    Bytes found;
    dl_iterate_phdr([](dl_phdr_info* object, size_t, void* result) {
        for (int i = 0; i < object->dlpi_phnum; ++i) {
            const auto& segment = object->dlpi_phdr[i];
            if (segment.p_type != PT_NOTE) continue;
            const Bytes id = build_id_of({reinterpret_cast<const std::byte*>(object->dlpi_addr + segment.p_vaddr), segment.p_memsz});
            if (!id.empty()) *static_cast<Bytes*>(result) = id;
        }
        return 1;  // the first object is the program; the others are its libraries
    }, &found);
    return found;
}

}  // namespace myriad::engine
