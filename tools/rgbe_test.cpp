#include "tools/rgbe.hpp"

#include <functional>
#include <limits>
#include <random>

#include "engine/error.hpp"
#include "tools/environment_file.hpp"
#include "tools/exr.hpp"
#include "tools/temp_folder.hpp"

namespace myriad::tools {
namespace {

using Code = std::array<uint8_t, 4>;

std::string header(const std::string& size) { return "#?RADIANCE\n# made by a test\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=3\n\n" + size + "\n"; }

// A row, run-length coded channel by channel: runs of 3 and more, the rest as they are.
std::string coded(const std::vector<Code>& row) {
    std::string out{2, 2, char(row.size() >> 8), char(row.size() & 255)};
    for (size_t c = 0; c < 4; ++c)
        for (size_t x = 0; x < row.size();) {
            size_t run = 1;
            while (x + run < row.size() && run < 127 && row[x + run][c] == row[x][c]) ++run;
            if (run >= 3) out += char(128 + run), out += char(row[x][c]), x += run;
            else out += char(1), out += char(row[x++][c]);
        }
    return out;
}

std::vector<std::vector<Code>> random_rows(uint32_t width, uint32_t height) {
    std::mt19937 random(3);
    std::vector<std::vector<Code>> rows(height);
    for (auto& row : rows)
        for (uint32_t x = 0; x < width; ++x)
            row.push_back(x && random() % 3 ? row.back() : Code{uint8_t(random()), uint8_t(128 + random() % 128), uint8_t(random()), uint8_t(random() % 5 ? 120 + random() % 16 : 0)});
    return rows;
}

class rgbe : public testing::Test {
protected:
    TempFolder folder;
    std::string write(const std::string& bytes) { return put(folder / "a.hdr", bytes), folder / "a.hdr"; }
    void refuse(const std::string& bytes, const std::string& part) {
        try {
            read_rgbe(write(bytes));
            ADD_FAILURE() << "accepted, but for " << part;
        } catch (const InputError& e) {
            EXPECT_TRUE(contains(e.what(), part) && contains(e.what(), "a.hdr")) << e.what();
        }
    }
    static void expect(const Image& image, const std::vector<std::vector<Code>>& rows, const std::function<size_t(size_t)>& row, bool mirrored = false) {
        ASSERT_EQ(image.height, rows.size());
        ASSERT_EQ(image.width, rows[0].size());
        for (size_t y = 0; y < rows.size(); ++y)
            for (size_t x = 0; x < image.width; ++x)
                for (size_t c = 0; c < 3; ++c) {
                    const Code& code = rows[row(y)][mirrored ? image.width - 1 - x : x];
                    ASSERT_EQ(image.channels[c].values[y * image.width + x], code[3] ? float(code[c]) * std::pow(2.0f, float(code[3]) - 136) : 0) << x << " " << y;
                }
    }
};

TEST_F(rgbe, rows_coded_and_plain_in_both_directions) {
    for (uint32_t width : {8u, 130u, 300u}) {
        const auto rows = random_rows(width, 5);
        std::string in_runs, plain;
        for (const auto& row : rows) {
            in_runs += coded(row);
            for (const Code& code : row) plain.append(code.begin(), code.end());
        }
        const std::string w = std::to_string(width);
        const auto same = [](size_t y) { return y; };
        const auto turned = [](size_t y) { return 4 - y; };
        expect(read_rgbe(write(header("-Y 5 +X " + w) + in_runs)), rows, same);
        expect(read_rgbe(write(header("-Y 5 +X " + w) + plain)), rows, same);
        expect(read_rgbe(write(header("+Y 5 +X " + w) + in_runs)), rows, turned);
        expect(read_rgbe(write(header("-Y 5 -X " + w) + plain)), rows, same, true);
    }
}

TEST_F(rgbe, runs_of_old) {
    const Code a{10, 20, 30, 130}, b{200, 1, 2, 140};
    const std::vector<std::vector<Code>> rows{{a, a, a, a, b}};
    std::string bytes(a.begin(), a.end());
    bytes += std::string{1, 1, 1, 3} + std::string(b.begin(), b.end());
    expect(read_rgbe(write(header("-Y 1 +X 5") + bytes)), rows, [](size_t y) { return y; });
    std::vector<Code> many(1 + 5 + 256, a);
    bytes = std::string(a.begin(), a.end()) + std::string{1, 1, 1, 5} + std::string{1, 1, 1, 1};
    expect(read_rgbe(write(header("-Y 1 +X 262") + bytes)), {many}, [](size_t y) { return y; });
}

TEST_F(rgbe, files_that_end_anywhere_are_refused) {
    const auto rows = random_rows(40, 3);
    std::string bytes = header("-Y 3 +X 40");
    for (const auto& row : rows) bytes += coded(row);
    EXPECT_NO_THROW(read_rgbe(write(bytes)));
    for (size_t n = 0; n < bytes.size(); ++n) refuse(bytes.substr(0, n), "");
}

TEST_F(rgbe, what_is_wrong_is_named) {
    refuse("P5\nnot this", "not a Radiance picture");
    refuse("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 8\n", "32-bit_rle_xyze");
    refuse("#?RADIANCE\n\n-Y 1 +X 8\n", "no format");
    refuse(header("+X 8 -Y 1"), "rows are not stored");
    refuse(header("-Y 100000 +X 100000"), "2^26");
    refuse(header("-Y -1 +X 8"), "2^26");
    refuse(header("-Y 8000 +X 8000"), "fewer bytes");
    refuse(header("-Y 1 +X 8") + std::string{2, 2, 0, 9}, "another width");
    refuse(header("-Y 1 +X 8") + std::string{2, 2, 0, 8, 0}, "run that does not fit");
    refuse(header("-Y 1 +X 8") + std::string{2, 2, 0, 8, 9}, "run that does not fit");
    refuse(header("-Y 1 +X 8") + std::string{1, 1, 1, 4}, "run that does not fit");
    EXPECT_THROW(read_rgbe(folder / "none.hdr"), InputError);
}

class environment_file : public rgbe {
protected:
    std::vector<std::string> warnings;
    void refuse_environment(const std::string& path, const std::string& part) {
        try {
            read_environment(path, 1, 0, warnings);
            ADD_FAILURE() << "accepted, but for " << part;
        } catch (const InputError& e) {
            EXPECT_TRUE(contains(e.what(), part) && contains(e.what(), path)) << e.what();
        }
    }
};

TEST_F(environment_file, both_formats_as_stored_times_strength) {
    const auto rows = random_rows(8, 4);
    std::string bytes = header("-Y 4 +X 8");
    for (const auto& row : rows) bytes += coded(row);
    const scenes::Environment hdr = read_environment(write(bytes), 2, 0.5, warnings);
    EXPECT_EQ(hdr.rotation, 0.5);
    Image image;
    image.width = 8, image.height = 4;
    for (const char* name : {"R", "G", "B"}) image.add(name);
    for (size_t i = 0; i < 32; ++i)
        for (size_t c = 0; c < 3; ++c) image.channels[c].values[i] = 0.5f * hdr.texels[i][int(c)];
    write_exr(folder / "a.exr", image, ExrColour::full);
    const scenes::Environment exr = read_environment(folder / "a.exr", 2, 0, warnings);
    EXPECT_EQ(exr.texels, hdr.texels);
    EXPECT_TRUE(warnings.empty());
}

TEST_F(environment_file, bad_texels_are_counted_and_repaired) {
    Image image;
    image.width = 4, image.height = 2;
    const float inf = std::numeric_limits<float>::infinity();
    image.add("R") = {1, -2, inf, std::nanf(""), 0, 0, 0, 2e10f};
    image.add("G") = {1, 5, 5, 5, 0, 0, 0, 0};
    image.add("B") = {1, 5, 5, 5, 0, 0, 0, 0};
    write_exr(folder / "a.exr", image, ExrColour::full);
    const scenes::Environment e = read_environment(folder / "a.exr", 1, 0, warnings);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(contains(warnings[0], "4 of 8 texels") && contains(warnings[0], "a.exr")) << warnings[0];
    EXPECT_EQ(e.texels[1], glm::vec3(0, 5, 5));
    EXPECT_EQ(e.texels[2], glm::vec3(1e9f, 5, 5));
    EXPECT_EQ(e.texels[3], glm::vec3(0, 5, 5));
    EXPECT_EQ(e.texels[7], glm::vec3(1e9f, 0, 0));
}

TEST_F(environment_file, what_is_no_equirectangular_picture_is_refused) {
    refuse_environment(folder / "none.exr", "none.exr");
    put(folder / "text.exr", "some text");
    refuse_environment(folder / "text.exr", "neither an OpenEXR nor a Radiance picture");
    Image image;
    image.width = 6, image.height = 1;
    image.add("R"), image.add("G"), image.add("B");
    write_exr(folder / "strip.exr", image);
    refuse_environment(folder / "strip.exr", "6x1");
    Image depth;
    depth.width = 2, depth.height = 1;
    depth.add("Z");
    write_exr(folder / "depth.exr", depth);
    refuse_environment(folder / "depth.exr", "no channels");
}

}  // namespace
}  // namespace myriad::tools
