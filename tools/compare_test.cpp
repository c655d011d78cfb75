#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <limits>

#include "tools/commands.hpp"
#include "tools/exr.hpp"
#include "tools/png.hpp"
#include "tools/temp_folder.hpp"

namespace myriad::tools {
namespace {

struct Outcome {
    int status = 0;
    std::string out, message;
    nlohmann::json json() const { return nlohmann::json::parse(out); }
};

Outcome compare(std::vector<std::string> arguments) {
    CLI::App app;
    add_compare(app);
    std::ranges::reverse(arguments);
    arguments.push_back("compare");  // CLI11 takes them from the back
    Outcome outcome;
    testing::internal::CaptureStdout();
    try {
        app.parse(arguments);
    } catch (const CLI::ParseError& e) {
        outcome.status = 2, outcome.message = e.what();
    } catch (const Error& e) {
        outcome.status = e.exit_status(), outcome.message = e.what();
    }
    outcome.out = testing::internal::GetCapturedStdout();
    return outcome;
}

class compare_command : public testing::Test {
protected:
    compare_command() {
        Image image;
        image.width = 16, image.height = 12;
        for (const char* name : {"R", "G", "B", "Z"})
            for (float& v : image.add(name)) v = static_cast<float>(&v - image.channels.back().values.data()) / 256;  // exact
        write_exr(r, image, ExrColour::full);
        for (int c = 0; c < 3; ++c) image.channels[c].values[50] += 0.25f;
        write_exr(t, image, ExrColour::full);
        image.channels[1].values[17] = std::numeric_limits<float>::quiet_NaN();
        image.channels[1].values[18] = std::numeric_limits<float>::infinity();
        write_exr(bad, image, ExrColour::full);
    }
    TempFolder folder;
    const std::string r = folder / "r.exr", t = folder / "t.exr", bad = folder / "bad.exr";
};

TEST_F(compare_command, json_has_the_metrics_as_keys) {
    const Outcome outcome = compare({r, t, "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.message;
    const auto json = outcome.json();
    EXPECT_DOUBLE_EQ(json["MSE"], 0.0625 / 192);
    EXPECT_DOUBLE_EQ(json["failing"], 1. / 192);
    EXPECT_GT(json["relMSE"], 0);
    EXPECT_LT(json["SSIM"], 1);
    EXPECT_LT(json["PSNR"], 60);
    EXPECT_EQ(json["failed"], false);
}

TEST_F(compare_command, identical_images_have_a_number_for_psnr) {
    const auto json = compare({r, r, "--json"}).json();
    EXPECT_EQ(json["PSNR"], 200);
    EXPECT_EQ(json["MSE"], 0);
    EXPECT_EQ(compare({r, r, "--fail-above", "MSE=0", "--fail-above", "relMSE=0", "--fail-below", "PSNR=199"}).status, 0);
}

TEST_F(compare_command, table_names_every_metric) {
    const std::string table = compare({r, t}).out;
    for (const char* name :
         {"relMSE", "MSE", "PSNR", "SSIM", "FLIP", "p95FLIP", "HDR-FLIP", "p95HDR-FLIP", "MAE", "maxAbs", "p95Abs", "failing", "tolerance"})
        EXPECT_TRUE(contains(table, name)) << name;
}

TEST_F(compare_command, each_limit_can_fail) {
    for (const char* metric : {"relMSE", "MSE", "FLIP", "p95FLIP", "HDR-FLIP", "p95HDR-FLIP", "MAE", "maxAbs", "failing"}) {
        const Outcome outcome = compare({"--fail-above", metric + std::string("=1e-6"), r, t});
        EXPECT_EQ(outcome.status, 1) << metric;
        EXPECT_TRUE(contains(outcome.message, metric)) << outcome.message;
        EXPECT_EQ(compare({"--fail-above", metric + std::string("=1"), r, t}).status, 0) << metric;
    }
    for (const char* limit : {"SSIM=0.9999", "PSNR=100"}) {
        EXPECT_EQ(compare({r, t, "--fail-below", limit}).status, 1) << limit;
        EXPECT_EQ(compare({r, r, "--fail-below", limit}).status, 0) << limit;
    }
    Image image = read_exr(r);
    for (auto& channel : image.channels)
        for (float& v : channel.values) v += 1;
    const std::string brighter = folder / "brighter.exr";
    write_exr(brighter, image, ExrColour::full);
    for (const char* metric : {"p95Abs", "clipped"}) {
        const std::string limit = metric + std::string("=0.5");
        EXPECT_EQ(compare({brighter, r, "--fail-above", limit}).status, 1) << metric;
        EXPECT_EQ(compare({r, t, "--fail-above", limit}).status, 0) << metric;
    }
    const Outcome two = compare({r, t, "--json", "--fail-above", "MSE=1", "--fail-above", "maxAbs=0.1", "--fail-below", "SSIM=1"});
    EXPECT_EQ(two.status, 1);
    EXPECT_EQ(two.json()["failed"], true);
    EXPECT_TRUE(contains(two.message, "maxAbs") && contains(two.message, "SSIM") && !contains(two.message, "MSE =")) << two.message;
}

TEST_F(compare_command, tolerance_decides_what_fails) {
    EXPECT_EQ(compare({r, t, "--json", "--tolerance", "0.3"}).json()["failing"], 0);
    EXPECT_EQ(compare({r, t, "--tolerance", "-1"}).status, 2);
}

TEST_F(compare_command, non_finite_values_fail_without_a_limit) {
    for (const auto& pair : {std::vector{r, bad}, {bad, r}, {bad, bad}}) {
        const Outcome outcome = compare({pair[0], pair[1], "--json"});
        EXPECT_EQ(outcome.status, 1);
        EXPECT_TRUE(contains(outcome.message, "1 NaN and 1 Inf") && contains(outcome.message, "1,1")) << outcome.message;
        EXPECT_TRUE(outcome.json()["MSE"].is_null());
        EXPECT_TRUE(outcome.json()["FLIP"].is_null());
    }
    EXPECT_EQ(compare({r, bad, "--json"}).json()["nonFinite"]["test"]["NaN"], 1);
}

TEST_F(compare_command, bad_usage_and_bad_input) {
    const Outcome unknown = compare({r, t, "--fail-above", "rmse=1"});
    EXPECT_EQ(unknown.status, 2);
    EXPECT_TRUE(contains(unknown.message, "'rmse'") && contains(unknown.message, "relMSE, MSE, PSNR, SSIM")) << unknown.message;
    for (const char* limit : {"MSE", "MSE=", "MSE=x", "MSE=1x", "MSE=nan", "=1"})
        EXPECT_EQ(compare({r, t, "--fail-above", limit}).status, 2) << limit;
    EXPECT_EQ(compare({r}).status, 2);
    EXPECT_EQ(compare({r, t, "--unheard-of"}).status, 2);
    EXPECT_EQ(compare({r, t, "--layer", "direct"}).status, 2);
    EXPECT_EQ(compare({r, t, "--diff", "d.jpg"}).status, 2);
    EXPECT_EQ(compare({r, t, "--diff-metric", "FLIP"}).status, 2) << "of no --diff";
    EXPECT_EQ(compare({r, t, "--diff", "d.png", "--diff-metric", "SSIM"}).status, 2);
    for (const char* option : {"--heat-maps", "--junit", "--bless"})
        EXPECT_TRUE(contains(compare({r, t, option, "x"}).message, "--golden")) << option;
    for (const char* ppd : {"0", "-67", "nan", "1001"}) EXPECT_EQ(compare({r, t, "--ppd", ppd}).status, 2) << ppd;
    EXPECT_EQ(compare({r, folder / "none.exr"}).status, 2);
}

TEST_F(compare_command, layers) {
    EXPECT_EQ(compare({r, t, "--layer", "Z", "--fail-above", "MSE=0"}).status, 0);
    EXPECT_EQ(compare({r, t, "--fail-above", "MSE=0"}).status, 1);
}

TEST_F(compare_command, difference_images) {
    const std::string exr = folder / "d.exr", png = folder / "d.png";
    EXPECT_EQ(compare({r, t, "--diff", exr}).status, 0);
    EXPECT_EQ(read_exr(exr).rgb()->g[50], 0.25f);
    EXPECT_EQ(read_exr(exr).rgb()->g[51], 0.f);
    const Outcome map = compare({r, t, "--diff", png, "--fail-above", "MSE=0"});
    EXPECT_EQ(map.status, 1);
    EXPECT_TRUE(contains(map.out, "light yellow 0.25")) << map.out << " 1 pixel of 192 differs: the maximum is the scale";
    const Picture picture = read_png(png);
    EXPECT_EQ(picture.rgb[50 * 3], 255);
    EXPECT_EQ(picture.rgb[51 * 3], 8);
    EXPECT_EQ(compare({r, t, "--json", "--diff", png}).json()["diff"]["scale"], 0.25);
    EXPECT_EQ(compare({r, bad, "--diff", png}).status, 1) << "and the picture is written";
    EXPECT_EQ(read_png(png).rgb[17 * 3 + 2], 255) << "NaN is white";
}

TEST_F(compare_command, maps_of_flip) {
    const std::string exr = folder / "d.exr", png = folder / "d.png";
    for (const std::string metric : {"FLIP", "HDR-FLIP"}) {
        const auto json = compare({r, t, "--json", "--diff", exr, "--diff-metric", metric}).json();
        EXPECT_EQ(json["diff"]["metric"], metric);
        double sum = 0;
        const Image map = read_exr(exr);
        for (float v : map.find("G")->values) sum += v;
        EXPECT_NEAR(double(json[metric]), sum / 192, 1e-6) << "the metric is the map's mean";
        const auto drawn = compare({r, t, "--json", "--diff", png, "--diff-metric", metric}).json();
        EXPECT_EQ(drawn["diff"]["scale"], 1);
        const Picture picture = read_png(png);
        EXPECT_GT(picture.rgb[50 * 3], picture.rgb[191 * 3]) << "brighter where the error is";
        EXPECT_EQ(compare({r, bad, "--diff", png, "--diff-metric", metric}).status, 1);
        EXPECT_EQ(read_png(png).rgb[17 * 3], 255) << "NaN is white";
        EXPECT_LT(read_png(png).rgb[100 * 3], 255);
    }
    EXPECT_GT(double(compare({r, t, "--json", "--ppd", "30"}).json()["p95FLIP"]), 0);
    EXPECT_NE(compare({r, t, "--json", "--ppd", "30"}).json()["FLIP"], compare({r, t, "--json"}).json()["FLIP"]);
}

}  // namespace
}  // namespace myriad::tools
