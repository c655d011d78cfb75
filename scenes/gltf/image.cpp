#include "scenes/gltf/image.hpp"

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>

#include <jpeglib.h>
#include <jerror.h>
#include <png.h>

#include "scenes/gltf/uri.hpp"

namespace myriad::scenes::gltf {
namespace {

// Both libraries report errors by longjmp(), which runs no destructors: whatever owns memory lives outside the functions
// that call setjmp(), and these throw nothing themselves but return what went wrong.
struct Problem {
    std::string text;  // "" for none
    std::jmp_buf at;
};

bool size_is_sane(uint32_t width, uint32_t height) {
    return width > 0 && height > 0 && width <= limits::image_side && height <= limits::image_side;
}

// ---- PNG

struct PngInput {
    Range left;
    Problem problem;
};

void png_failed(png_structp png, png_const_charp message) {
    auto& input = *static_cast<PngInput*>(png_get_error_ptr(png));
    input.problem.text = message;
    std::longjmp(input.problem.at, 1);
}

void png_pull(png_structp png, png_bytep to, size_t count) {
    Range& left = static_cast<PngInput*>(png_get_io_ptr(png))->left;
    if (count > left.size) png_error(png, "it is truncated");
    std::memcpy(to, left.data, count);
    left = {left.data + count, left.size - count};
}

// A reader of a PNG, and the end of it.
struct PngReader {
    explicit PngReader(PngInput& input) {
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, png_failed, [](png_structp, png_const_charp) {});
        info = png ? png_create_info_struct(png) : nullptr;
        if (!info) throw std::bad_alloc();
        png_set_read_fn(png, &input, png_pull);
    }
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
    PngReader(const PngReader&) = delete;
    png_structp png = nullptr;
    png_infop info = nullptr;
};

bool png_header(PngReader& in, PngInput& input, Picture& out) {
    if (setjmp(input.problem.at)) return false;
    png_set_user_limits(in.png, limits::image_side, limits::image_side);
    png_set_chunk_malloc_max(in.png, 1 << 20);  // texts and profiles, none of which is used
    png_set_chunk_cache_max(in.png, 100);
    png_read_info(in.png, in.info);
    out.width = png_get_image_width(in.png, in.info);
    out.height = png_get_image_height(in.png, in.info);
    return true;
}

bool png_pixels(PngReader& in, PngInput& input, uint8_t* rgba, uint8_t** rows) {
    if (setjmp(input.problem.at)) return false;
    png_set_expand(in.png);  // palettes, fewer than 8 bits, and transparency that is a colour
    png_set_scale_16(in.png);
    png_set_gray_to_rgb(in.png);
    png_set_add_alpha(in.png, 0xff, PNG_FILLER_AFTER);
    png_set_interlace_handling(in.png);
    png_read_update_info(in.png, in.info);
    const size_t row = size_t(png_get_image_width(in.png, in.info)) * 4, height = png_get_image_height(in.png, in.info);
    if (png_get_rowbytes(in.png, in.info) != row) png_error(in.png, "its pixels are of an unknown kind");
    for (size_t y = 0; y < height; ++y) rows[y] = rgba + y * row;
    png_read_image(in.png, rows);
    png_read_end(in.png, nullptr);
    return true;
}

std::string decode_png(const Place& place, Range bytes, Picture& out) {
    PngInput input{bytes, {}};
    PngReader in(input);
    if (!png_header(in, input, out)) return input.problem.text;
    if (!size_is_sane(out.width, out.height)) return "its size is beyond reason";
    place.spend(uint64_t(out.width) * out.height, 4);
    out.rgba.resize(size_t(out.width) * out.height * 4);
    std::vector<uint8_t*> rows(out.height);
    return png_pixels(in, input, out.rgba.data(), rows.data()) ? "" : input.problem.text;
}

// ---- JPEG

[[noreturn]] void stop_jpeg(j_common_ptr info, const char* why) {
    auto& problem = *static_cast<Problem*>(info->client_data);
    char text[JMSG_LENGTH_MAX];
    if (!why) info->err->format_message(info, text);
    problem.text = why ? why : text;
    std::longjmp(problem.at, 1);
}

struct JpegReader {
    JpegReader() {
        in.err = jpeg_std_error(&manager);
        in.client_data = &problem;
        manager.error_exit = [](j_common_ptr info) { stop_jpeg(info, nullptr); };
        // Warnings are below 0. Damage inside shows as a blemish; an end that is missing does not go unnoticed.
        manager.emit_message = [](j_common_ptr info, int level) {
            if (level < 0 && info->err->msg_code == JWRN_JPEG_EOF) stop_jpeg(info, "it is truncated");
        };
        monitor.progress_monitor = [](j_common_ptr info) {
            if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number > limits::jpeg_scans) stop_jpeg(info, "it has too many scans");
        };
    }
    ~JpegReader() { jpeg_destroy_decompress(&in); }  // harmless before it is created
    JpegReader(const JpegReader&) = delete;

    jpeg_decompress_struct in{};
    jpeg_error_mgr manager{};
    jpeg_progress_mgr monitor{};
    Problem problem;
};

bool jpeg_header(JpegReader& reader, Range bytes) {
    if (setjmp(reader.problem.at)) return false;
    jpeg_create_decompress(&reader.in);
    reader.in.progress = &reader.monitor;
    jpeg_mem_src(&reader.in, bytes.data, bytes.size);
    jpeg_read_header(&reader.in, TRUE);
    return true;
}

bool jpeg_pixels(JpegReader& reader, uint8_t* rgba) {
    if (setjmp(reader.problem.at)) return false;
    reader.in.out_color_space = reader.in.num_components == 4 ? JCS_CMYK : JCS_EXT_RGBA;
    jpeg_start_decompress(&reader.in);
    while (reader.in.output_scanline < reader.in.output_height) {
        JSAMPROW row = rgba + size_t(reader.in.output_scanline) * reader.in.output_width * 4;
        jpeg_read_scanlines(&reader.in, &row, 1);
    }
    jpeg_finish_decompress(&reader.in);
    return true;
}

// Adobe's programs store ink upside down: 255 is none.
void cmyk_to_rgba(Bytes& pixels, bool adobe) {
    const int flip = adobe ? 0 : 255;
    for (size_t i = 0; i < pixels.size(); i += 4) {
        const int key = pixels[i + 3] ^ flip;
        for (size_t c = 0; c < 3; ++c) pixels[i + c] = uint8_t(((pixels[i + c] ^ flip) * key + 127) / 255);
        pixels[i + 3] = 255;
    }
}

std::string decode_jpeg(const Place& place, Range bytes, Picture& out) {
    JpegReader reader;
    if (!jpeg_header(reader, bytes)) return reader.problem.text;
    const auto& in = reader.in;
    if (!size_is_sane(in.image_width, in.image_height)) return "its size is beyond reason";
    if (in.num_components != 1 && in.num_components != 3 && in.num_components != 4) return "its number of channels is unknown";
    out.width = in.image_width, out.height = in.image_height;
    // RGBA, and what libjpeg keeps of a progressive picture: a 16-bit coefficient for each channel of each pixel.
    place.spend(uint64_t(out.width) * out.height, 4 + 2 * uint64_t(in.num_components));
    out.rgba.resize(size_t(out.width) * out.height * 4);
    if (!jpeg_pixels(reader, out.rgba.data())) return reader.problem.text;
    if (in.num_components == 4) cmyk_to_rgba(out.rgba, in.saw_Adobe_marker);
    return "";
}

bool starts_with(Range bytes, const char* magic, size_t size) { return bytes.size >= size && std::memcmp(bytes.data, magic, size) == 0; }

}  // namespace

Picture decode_picture(const Place& place, Range bytes) {
    Picture out;
    std::string problem = "it is neither PNG nor JPEG";
    if (starts_with(bytes, "\x89PNG\r\n\x1a\n", 8)) problem = decode_png(place, bytes, out);
    else if (starts_with(bytes, "\xff\xd8\xff", 3)) problem = decode_jpeg(place, bytes, out);
    if (!problem.empty()) place.fail("the image cannot be decoded (" + problem + ")", "store it as PNG or JPEG");
    return out;
}

Picture read_image(const Place& place, int index) {
    const auto& images = place.model.images;
    if (index < 0 || size_t(index) >= images.size()) place.fail("there is no image " + std::to_string(index), "export the file again");
    const auto& image = images[size_t(index)];
    const Place here = place.at("image " + std::to_string(index));
    if (image.bufferView >= 0) return decode_picture(here, buffer_view(here, image.bufferView));
    const Bytes bytes = read_uri(here, image.uri);
    return decode_picture(here, {bytes.data(), bytes.size()});
}

}  // namespace myriad::scenes::gltf
