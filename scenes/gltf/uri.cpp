#include "scenes/gltf/uri.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace myriad::scenes::gltf {
namespace {

namespace fs = std::filesystem;

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// Once, and only once. An escape that is none stays as it is: exporters forget to encode "100%.png".
std::string percent_decoded(const std::string& in) {
    std::string out;
    for (size_t i = 0; i < in.size(); ++i) {
        const int high = in[i] == '%' && i + 2 < in.size() ? hex_digit(in[i + 1]) : -1, low = high >= 0 ? hex_digit(in[i + 2]) : -1;
        if (low >= 0) out.push_back(char(high * 16 + low)), i += 2;
        else out.push_back(in[i]);
    }
    return out;
}

// RFC 3986: a letter, then letters, digits, "+", "-", "."; a colon ends it. A drive letter of Windows is one too.
bool has_scheme(const std::string& uri) {
    const size_t colon = uri.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+-.");
    return colon != std::string::npos && colon > 0 && uri[colon] == ':';
}

bool inside(const fs::path& path, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

bool is_data(const std::string& uri) { return uri.starts_with("data:"); }

Bytes from_data_uri(const Place& place, const std::string& uri) {
    Bytes bytes;
    std::string type;
    place.spend(uri.size(), 1);
    if (!tinygltf::DecodeDataURI(&bytes, type, uri, 0, false))
        place.fail("the data URI " + quote(uri) + " is not base64 of a known type", "export the file again as .glb");
    return bytes;
}

}  // namespace

std::string file_of_uri(const Place& place, const std::string& uri) {
    if (is_data(uri)) return "";
    const std::string beside = "put the file into the scene's folder and refer to it by a relative path";
    std::string name = percent_decoded(uri);
    std::ranges::replace(name, '\\', '/');
    if (name.empty()) place.fail("the URI is empty", "export the file again");
    if (has_scheme(uri) || has_scheme(name)) place.fail("the URI " + quote(uri) + " is not a path", beside);
    if (std::ranges::any_of(name, [](unsigned char c) { return c < ' ' || c == 0x7f; }))
        place.fail("the URI " + quote(uri) + " has a control character", "rename the file");
    if (name.size() > 4096) place.fail("the URI " + quote(uri) + " is too long", beside);
    const std::string leaves = "the URI " + quote(uri) + " leaves the scene's folder";
    const fs::path relative = fs::path(name).lexically_normal();
    if (relative.is_absolute() || *relative.begin() == "..") place.fail(leaves, beside);

    std::error_code error;
    const fs::path folder = fs::canonical(place.document->folder.empty() ? "." : place.document->folder, error);
    const fs::path file = error ? fs::path() : fs::canonical(folder / relative, error);
    if (error) place.fail("the file " + quote(name) + " cannot be read", "put it beside the glTF file");
    if (!inside(file, folder)) place.fail(leaves + " by a symbolic link", beside);
    // A device never ends, and a pipe never begins.
    if (!fs::is_regular_file(file, error)) place.fail(quote(name) + " is not a regular file", "put it beside the glTF file");
    return file.string();
}

Bytes read_uri(const Place& place, const std::string& uri) {
    if (is_data(uri)) return from_data_uri(place, uri);
    const std::string path = file_of_uri(place, uri);
    std::error_code error;
    const uint64_t size = fs::file_size(path, error);
    Document& document = *place.document;
    if (!error && document.files.insert(path).second) document.budget.earn(size);  // a file counts once, however often it is named
    if (!error) place.spend(size, 1);
    Bytes bytes(error ? 0 : size);
    std::ifstream file(path, std::ios::binary);
    if (error || !file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size)))
        place.fail("the file " + quote(uri) + " cannot be read", "check its permissions");
    return bytes;
}

}  // namespace myriad::scenes::gltf
