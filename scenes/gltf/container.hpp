// From a file on disk to a tinygltf model and the bytes that it refers to. Nothing but JSON reaches tinygltf: it opens no
// file, decodes no base64 and no picture, and never sees a buffer.
#pragma once

#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "scenes/gltf/limits.hpp"

namespace myriad::scenes::gltf {

using Bytes = std::vector<uint8_t>;

struct Range {
    const uint8_t* data = nullptr;
    size_t size = 0;
};

// A file taken apart. `model.buffers` is empty. `model.images` has names, types, URIs and buffer views, no bytes: images
// are read when they are used (image.hpp).
struct Document {
    Document() = default;
    Document(Document&&) = default;  // `buffers` would point into the original of a copy

    tinygltf::Model model;
    std::vector<Range> buffers;  // the bytes of each glTF buffer; none where the file gives it none (a fallback of meshopt's)
    std::string file, folder;    // the file's path, and the folder which its URIs may not leave
    Budget budget;
    std::set<std::string> files;  // those that have been read, besides the file itself
    std::deque<Bytes> owned;     // what `buffers` and `decoded` point into
    std::map<int, Range> decoded;  // compressed buffer views that have been asked for (meshopt.hpp)
};

// Throws InputError, OutOfMemory. What tinygltf warns of goes to `warnings`, a line each.
Document read_document(const std::string& path, std::string& warnings);

}  // namespace myriad::scenes::gltf
