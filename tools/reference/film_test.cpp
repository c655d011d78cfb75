#include <gtest/gtest.h>

#include "tools/exr.hpp"
#include "tools/reference/resume.hpp"
#include "tools/reference/testing.hpp"
#include "tools/temp_folder.hpp"

namespace myriad::reference {
namespace {

using tools::contains, tools::input_error;

TEST(ReferenceFilm, means_and_the_variance_of_the_mean) {
    Film film(1, 1);
    double mean = 0, squares = 0;
    for (const float x : {1.0f, 4.0f, 2.0f, 9.0f}) {
        film.add(0, {vec3(1), vec3(x), vec3(0.5f * x)});
        film.end_pass(0);
        mean += (1 + 1.5 * double(x)) / 4, squares += std::pow(1 + 1.5 * double(x), 2) / 4;
    }
    const tools::Image image = film.image(false);
    EXPECT_FLOAT_EQ(image.find("G")->values[0], float(mean));
    EXPECT_FLOAT_EQ(image.find("direct.G")->values[0], 4);
    EXPECT_FLOAT_EQ(image.find("indirect.G")->values[0], 2);
    EXPECT_FLOAT_EQ(image.find("variance.G")->values[0], float((squares - mean * mean) / 3));
    EXPECT_EQ(image.metadata.at("samples"), "4");
    EXPECT_EQ(image.find("sum.G"), nullptr);
}

TEST(ReferenceFilm, sums_of_many_are_good_to_48_bits) {
    Sum sum;
    double exact = 0;
    for (int i = 0; i < 100000; ++i) sum.add(0.1 * i), exact += 0.1 * i;
    EXPECT_NEAR(sum.value() / exact, 1, 1e-10);
}

TEST(ReferenceFilm, no_number_is_told) {
    EXPECT_TRUE(Film::finite({vec3(1), vec3(2), vec3(3)}));
    EXPECT_FALSE(Film::finite({vec3(1), vec3(NAN), vec3(3)}));
    EXPECT_FALSE(Film::finite({vec3(1), vec3(1e30f), vec3(3)}));
}

TEST(ReferenceFilm, a_file_goes_on_where_it_ended) {
    const tools::TempFolder folder;
    tests::Kit kit = tests::Kit::room();
    const Film film = film_of(kit.scene, small(3, 1));
    const std::map<std::string, std::string> about = {{"scene", "room"}, {"seed", "1"}};
    tools::Image image = film.image(true);
    for (const auto& [key, value] : about) image.metadata[key] = value;
    tools::write_exr(folder / "a.exr", image, tools::ExrColour::full);
    const Film again = resumed(tools::read_exr(folder / "a.exr"), Film(8, 8), about);
    EXPECT_EQ(again.samples(), 3u);
    const tools::Image both = again.image(true);
    for (size_t k = 0; k < both.channels.size(); ++k) EXPECT_EQ(both.channels[k].values, image.channels[k].values);
}

TEST(ReferenceFilm, other_settings_are_refused) {
    tests::Kit kit = tests::Kit::room();
    tools::Image image = film_of(kit.scene, small(1)).image(true);
    image.origin = "a.exr";
    image.metadata["seed"] = "1";
    EXPECT_EQ(input_error([&] { resumed(image, Film(8, 8), {{"seed", "2"}}); }),
              "'a.exr' has seed 1, and 2 is asked for; give the settings that it was made with, or leave --resume out");
    EXPECT_TRUE(contains(input_error([&] { resumed(image, Film(8, 8), {{"bounces", "2"}}); }), "bounces none, and 2"));
    EXPECT_TRUE(contains(input_error([&] { resumed(image, Film(8, 9), {{"seed", "1"}}); }), "8x8, and 8x9"));
    EXPECT_TRUE(contains(input_error([&] { resumed(image, Film(8, 8), {}); }), "seed 1, and none"));
    tools::Image without = film_of(kit.scene, small(1)).image(false);
    EXPECT_TRUE(contains(input_error([&] { resumed(without, Film(8, 8), {}); }), "keeps no sums"));
    image.metadata["samples"] = "3x";
    EXPECT_TRUE(contains(input_error([&] { resumed(image, Film(8, 8), {{"seed", "1"}}); }), "how many samples"));
}

TEST(ReferenceFilm, a_scene_is_known_by_what_is_seen) {
    tests::Kit kit = tests::Kit::room();
    const auto digest = [&] { return scene_digest(kit.scene, kit.scene.lights, scenes::flatten(kit.scene, scenes::Sharing::never), kit.scene.cameras[0]); };
    const std::string before = digest();
    EXPECT_EQ(digest(), before);
    kit.scene.materials[1].emissive.x = 0.1f;
    const std::string lit = digest();
    EXPECT_NE(lit, before);
    kit.scene.lights[0].radius = 0.1f;
    EXPECT_NE(digest(), lit);
    kit.scene.lights[0].radius = 0;
    kit.scene.meshes[0].primitives[0].positions[0].x += 0.01f;
    EXPECT_NE(digest(), lit);
}

}  // namespace
}  // namespace myriad::reference
