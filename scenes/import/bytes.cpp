#include "scenes/import/bytes.hpp"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>

#include <zlib.h>

#include "engine/error.hpp"

namespace myriad::scenes::importing {
namespace {

static_assert(std::endian::native == std::endian::little);

std::string mebibytes(uint64_t bytes) { return std::to_string(bytes >> 20) + " MiB"; }

// zlib's state, put away whatever happens.
struct Inflater {
    z_stream stream{};

    explicit Inflater(const std::string& name) {
        if (inflateInit2(&stream, 15 + 16) != Z_OK)  // 16: gzip's wrapping
            throw OutOfMemory(name + ": there is no memory to decompress it; close other programs.");
    }
    ~Inflater() { inflateEnd(&stream); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
};

}  // namespace

Bytes read_file(const std::string& path, uint64_t limit) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw InputError(path + ": there is no such file; check its name.");
    const uint64_t size = std::filesystem::file_size(path, error);
    if (error) throw InputError(path + ": the file cannot be read; check its permissions.");
    if (size > limit) throw InputError(path + ": the file has " + mebibytes(size) + ", more than the " + mebibytes(limit) + " that are read; cut it up.");
    Bytes bytes(size);
    std::ifstream file(path, std::ios::binary);
    if (!file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size)))
        throw InputError(path + ": the file cannot be read; check its permissions.");
    return bytes;
}

Bytes gunzip(Bytes bytes, const std::string& name, uint64_t limit) {
    if (bytes.size() < 2 || bytes[0] != 0x1f || bytes[1] != 0x8b) return bytes;
    const View view(bytes, name);
    Inflater inflater(name);
    z_stream& z = inflater.stream;
    Bytes out;
    size_t taken = 0, filled = 0;
    for (int status = Z_OK; status != Z_STREAM_END;) {
        if (z.avail_in == 0) {  // zlib counts in 32 bits
            const size_t piece = std::min(bytes.size() - taken, size_t(1) << 30);
            z.next_in = bytes.data() + taken, z.avail_in = uInt(piece);
            taken += piece;
        }
        if (filled == out.size()) {
            if (filled > limit) view.fail("it expands to more than " + mebibytes(limit), "it is no file of this kind");
            // One byte more than the limit may hold: whoever needs it is over.
            out.resize(size_t(std::min<uint64_t>(std::max<size_t>(2 * filled, 1 << 16), limit + 1)));
        }
        const size_t room = std::min(out.size() - filled, size_t(1) << 30);
        z.next_out = out.data() + filled, z.avail_out = uInt(room);
        status = inflate(&z, Z_NO_FLUSH);
        filled += room - z.avail_out;
        if (status == Z_BUF_ERROR && z.avail_in == 0 && taken == bytes.size()) view.fail("the gzip data end too early");
        if (status == Z_MEM_ERROR) throw OutOfMemory(name + ": there is no memory to decompress it; close other programs.");
        if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) view.fail("the gzip data are damaged");
    }
    if (filled > limit) view.fail("it expands to more than " + mebibytes(limit), "it is no file of this kind");
    out.resize(filled);
    return out;
}

void View::fail(const std::string& what, const std::string& cure) const { throw InputError(name_ + ": " + what + "; " + cure + "."); }

void View::check(uint64_t offset, uint64_t count, uint64_t size, const std::string& what) const {
    // In terms of what is left, so that nothing can wrap.
    if (offset <= bytes_.size() && count <= (bytes_.size() - offset) / size) return;
    fail(what + ": " + std::to_string(count) + " records of " + std::to_string(size) + " bytes from byte " + std::to_string(offset) +
         " on end beyond the file's " + std::to_string(bytes_.size()) + " bytes");
}

}  // namespace myriad::scenes::importing
