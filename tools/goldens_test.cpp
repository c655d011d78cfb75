// Folders of images through the command itself.
#include "tools/goldens.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
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
};

class goldens : public testing::Test {
protected:
    goldens() {
        for (const char* name : {"a.exr", "b.exr", "deep/c.exr"}) put_image(golden / name, 0.5f), put_image(test / name, 0.5f);
    }
    static void put_image(const std::filesystem::path& path, float value, uint32_t width = 8) {
        std::filesystem::create_directories(path.parent_path());
        Image image;
        image.width = width, image.height = 6;
        for (const char* name : {"R", "G", "B"}) std::ranges::fill(image.add(name), value);
        write_exr(path, image, ExrColour::full);
    }
    Outcome compare(std::vector<std::string> more, const std::string& limit = "maxAbs=0.01") {
        std::vector<std::string> arguments = {"compare", "--golden", golden, test};
        if (!limit.empty()) arguments.insert(arguments.end(), {"--fail-above", limit});
        arguments.insert(arguments.end(), more.begin(), more.end());
        std::ranges::reverse(arguments);  // CLI11 takes them from the back
        CLI::App app;
        add_compare(app);
        Outcome outcome;
        testing::internal::CaptureStdout();
        try {
            app.parse(arguments);
        } catch (const CLI::ParseError& e) {
            outcome = {2, "", e.what()};
        } catch (const Error& e) {
            outcome = {e.exit_status(), "", e.what()};
        }
        outcome.out = testing::internal::GetCapturedStdout();
        return outcome;
    }
    void fails(const std::string& part, const std::string& kind) {
        const Outcome outcome = compare({});
        EXPECT_EQ(outcome.status, 1) << outcome.out;
        EXPECT_TRUE(contains(outcome.message, part)) << outcome.message;
        EXPECT_TRUE(contains(outcome.out, "(1 " + kind + ")") && contains(outcome.out, part)) << outcome.out;
    }
    std::string log() { return bytes_of(golden / "blessed.log"); }

    TempFolder folder;
    const std::filesystem::path golden = folder / "golden", test = folder / "test";
};

TEST_F(goldens, same_images_pass) {
    const Outcome outcome = compare({}, "maxAbs=0");
    EXPECT_EQ(outcome.status, 0) << outcome.message;
    EXPECT_TRUE(contains(outcome.out, "3 images: 3 passed, 0 failed") && contains(outcome.out, "passed deep/c.exr")) << outcome.out;
}

TEST_F(goldens, each_kind_of_failure) {
    put_image(test / "b.exr", 0.52f);
    fails("maxAbs = 0.02 is not at most 0.01", "limit");
    put_image(test / "b.exr", std::nanf(""));
    fails("144 NaN and 0 Inf", "nonfinite");
    put_image(test / "b.exr", 0.5f, 9);
    fails("it is 9x6 and its golden 8x6", "size");
    put(test / "b.exr", "no image");
    fails("b.exr", "unreadable");
    std::filesystem::remove(test / "b.exr");
    fails("there is no '" + (test / "b.exr").string() + "'", "missing");
    std::filesystem::create_symlink("nowhere.exr", test / "b.exr");
    fails("b.exr", "unreadable");
    std::filesystem::remove(test / "b.exr"), std::filesystem::remove(golden / "b.exr"), put_image(test / "b.exr", 0.5f);
    fails("there is no golden", "extra");
    put(golden / "b.exr", "no image");
    fails("b.exr", "unreadable");
}

TEST_F(goldens, fails_below_a_value_and_by_flip) {
    put_image(test / "a.exr", 0.6f);
    EXPECT_EQ(compare({"--fail-below", "PSNR=60"}, "").status, 1);
    EXPECT_EQ(compare({}, "FLIP=0.05").status, 1);
    EXPECT_EQ(compare({}, "FLIP=0.5").status, 0);
    EXPECT_EQ(compare({"--tolerance", "19%"}, "failing=0.5").status, 1) << "0.1 is 20 % of 0.5";
    EXPECT_EQ(compare({"--tolerance", "21%"}, "failing=0.5").status, 0);
}

TEST_F(goldens, the_worst_comes_first) {
    put_image(test / "b.exr", 0.6f), put_image(test / "deep/c.exr", 0.9f);
    std::filesystem::remove(test / "a.exr");
    const Outcome outcome = compare({"--json"});
    const auto json = nlohmann::json::parse(outcome.out);
    std::string order;
    for (const auto& image : json["images"]) order += std::string(image["name"]) + " ";
    EXPECT_EQ(order, "a.exr deep/c.exr b.exr ");
    EXPECT_EQ(json["failed"], 3);
    EXPECT_EQ(json["images"][0]["kind"], "missing");
    EXPECT_NEAR(double(json["images"][1]["metrics"]["maxAbs"]), 0.4, 1e-6);
    EXPECT_EQ(json["limits"][0], "maxAbs <= 0.01");
    EXPECT_TRUE(contains(outcome.message, "3 of 3 images failed; the worst, 'a.exr'")) << outcome.message;
}

TEST_F(goldens, heat_maps_of_failures_or_of_all) {
    put_image(test / "deep/c.exr", 0.9f);
    const std::filesystem::path maps = folder / "new/maps";
    EXPECT_EQ(compare({"--heat-maps", maps}).status, 1);
    EXPECT_EQ(read_png(maps / "deep/c.png").width, 8u);
    EXPECT_FALSE(std::filesystem::exists(maps / "a.png"));
    EXPECT_EQ(compare({"--heat-maps", maps, "--all-heat-maps", "--diff-metric", "FLIP"}).status, 1);
    EXPECT_TRUE(std::filesystem::exists(maps / "a.png"));
    put(folder / "file", "");
    EXPECT_EQ(compare({"--heat-maps", folder / "file"}).status, 2);
}

TEST_F(goldens, junit_is_well_formed_whatever_the_names) {
    const std::string odd = "a<b>&\"'\x01\xff\xc3\xa4.exr";
    put_image(golden / odd, 0.5f), put_image(test / odd, 0.9f);
    std::filesystem::remove(test / "a.exr");
    const std::string file = folder / "junit.xml";
    EXPECT_EQ(compare({"--junit", file}).status, 1);
    const std::string xml = bytes_of(file);
    EXPECT_TRUE(xml.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>"));
    EXPECT_TRUE(contains(xml, "tests=\"4\" failures=\"2\" errors=\"0\"")) << xml;
    EXPECT_TRUE(contains(xml, "name=\"a&lt;b&gt;&amp;&quot;'\xef\xbf\xbd\xef\xbf\xbd\xc3\xa4.exr\"")) << xml;
    EXPECT_TRUE(contains(xml, "<failure type=\"missing\" message=\"there is no '")) << xml;
    EXPECT_TRUE(contains(xml, "<failure type=\"limit\" message=\"maxAbs = 0.4 is not at most 0.01\">")) << xml;
    EXPECT_EQ(compare({"--junit", folder / "none/junit.xml"}).status, 2) << "told before images are read";
}

TEST_F(goldens, blessing_replaces_and_logs) {
    put_image(test / "b.exr", 0.6f), put_image(test / "more/d.exr", 0.1f);
    const Outcome outcome = compare({"--bless", " softer\nshadows "}, "");
    EXPECT_EQ(outcome.status, 0) << outcome.message;
    EXPECT_TRUE(contains(outcome.out, "blessed b.exr\nblessed more/d.exr\n2 blessed")) << outcome.out;
    EXPECT_EQ(bytes_of(golden / "b.exr"), bytes_of(test / "b.exr"));
    EXPECT_TRUE(contains(log(), "Z  myriad ") && contains(log(), "  softer shadows\n  b.exr: relMSE ")) << log();
    EXPECT_TRUE(contains(log(), "maxAbs 0.1\n  more/d.exr: new\n")) << log();
    EXPECT_EQ(compare({}, "maxAbs=0").status, 0);

    const std::string before = log();
    EXPECT_TRUE(contains(compare({"--bless", "again"}, "").out, "all are as they were"));
    EXPECT_EQ(log(), before);
    put_image(test / "a.exr", 0.4f), put(golden / "b.exr", "damaged");
    EXPECT_EQ(compare({"--bless", "second"}, "").status, 0);
    EXPECT_TRUE(log().starts_with(before) && contains(log(), "  second\n  a.exr: ") && contains(log(), "b.exr: not comparable")) << log();
}

TEST_F(goldens, blessing_begins_where_there_are_none) {
    std::filesystem::remove_all(golden);
    EXPECT_EQ(compare({}).status, 2);
    put_image(test / "two\nlines.exr", 0.5f);
    EXPECT_EQ(compare({"--bless", "the first"}, "").status, 0);
    EXPECT_TRUE(contains(log(), "\n  two lines.exr: new\n")) << log();
    EXPECT_EQ(exr_names(golden), (std::vector<std::string>{"a.exr", "b.exr", "deep/c.exr", "two\nlines.exr"}));
}

TEST_F(goldens, blessing_refuses_and_changes_nothing) {
    put_image(test / "a.exr", 0.4f);
    const std::string before = bytes_of(golden / "a.exr");
    const auto refused = [&](const std::vector<std::string>& more, const std::string& part) {
        const Outcome outcome = compare(more, "");
        EXPECT_EQ(outcome.status, 2);
        EXPECT_TRUE(contains(outcome.message, part)) << outcome.message;
        EXPECT_EQ(bytes_of(golden / "a.exr"), before);
        EXPECT_FALSE(std::filesystem::exists(golden / "blessed.log"));
    };
    refused({"--bless", " \t"}, "no reason");
    refused({"--bless"}, "--bless");
    put_image(test / "deep/c.exr", std::numeric_limits<float>::infinity());
    refused({"--bless", "why"}, "NaN or Inf in");
    put(test / "deep/c.exr", "no image");
    refused({"--bless", "why"}, "c.exr");
    std::filesystem::remove(test / "deep/c.exr");
    refused({"--bless", "why"}, "nothing is blessed");
}

TEST_F(goldens, bad_usage) {
    const auto refused = [&](const std::vector<std::string>& more, const std::string& part, const std::string& limit = "maxAbs=0.01") {
        const Outcome outcome = compare(more, limit);
        EXPECT_EQ(outcome.status, 2) << part;
        EXPECT_TRUE(contains(outcome.message, part)) << outcome.message;
    };
    refused({}, "no limit is given", "");
    refused({test}, "2 given");
    refused({"--diff", "d.png"}, "--heat-maps");
    refused({"--all-heat-maps"}, "--heat-maps");
    refused({"--diff-metric", "FLIP"}, "--heat-maps");
    refused({"--bless", "why", "--junit", folder / "j.xml"}, "compare first");
    for (const char* tolerance : {"-1", "x", "%", "nan", "-1%", ""}) refused({"--tolerance", tolerance}, "--tolerance");
    std::filesystem::remove_all(golden), std::filesystem::create_directory(golden);
    refused({}, "holds no .exr");
    std::filesystem::remove(golden), std::filesystem::create_directory_symlink(test, golden);
    refused({}, "both");
    std::filesystem::remove_all(test);
    refused({}, "is no folder");
}

}  // namespace
}  // namespace myriad::tools
