// Tracks by closed forms, and what becomes of their ends.
#include "scenes/animation.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace myriad::scenes {
namespace {

using Interpolation = Track::Interpolation;

std::vector<double> at(const Track& track, double seconds, bool rotation = false) {
    std::vector<double> out(track.width);
    sample(track, rotation, seconds, out.data());
    return out;
}

// A turn about Y by so many degrees, as glTF writes it.
std::vector<float> about_y(double degrees) {
    const double half = glm::radians(degrees) / 2;
    return {0, float(std::sin(half)), 0, float(std::cos(half))};
}

Track turns(std::vector<float> times, const std::vector<std::vector<float>>& keys) {
    Track track{.width = 4, .times = std::move(times)};
    for (const auto& key : keys) track.values.insert(track.values.end(), key.begin(), key.end());
    return track;
}

double degrees_about_y(const std::vector<double>& q) { return glm::degrees(2 * std::atan2(q[1], q[3])); }

TEST(Track, StepHoldsItsKeyUntilTheNext) {
    const Track track{Interpolation::step, 1, {1, 2, 4}, {10, 20, 40}};
    EXPECT_EQ(at(track, 1)[0], 10);
    EXPECT_EQ(at(track, std::nextafter(2.0, 0.0))[0], 10);
    EXPECT_EQ(at(track, 2)[0], 20);
    EXPECT_EQ(at(track, 3.999)[0], 20);
    EXPECT_EQ(at(track, 4)[0], 40);
}

TEST(Track, LinearIsAStraightLineBetweenKeysAndExactAtThem) {
    const Track track{Interpolation::linear, 3, {0, 1, 3}, {0, 0, 0, 1, 2, -4, 5, 0, 0}};
    EXPECT_EQ(at(track, 0), (std::vector<double>{0, 0, 0}));
    EXPECT_EQ(at(track, 0.25), (std::vector<double>{0.25, 0.5, -1}));
    EXPECT_EQ(at(track, 1), (std::vector<double>{1, 2, -4}));
    EXPECT_EQ(at(track, 2), (std::vector<double>{3, 1, -2}));
}

TEST(Track, EndsHold) {
    for (const auto interpolation : {Interpolation::step, Interpolation::linear}) {
        const Track track{interpolation, 1, {1, 2}, {10, 20}};
        EXPECT_EQ(at(track, -5)[0], 10);
        EXPECT_EQ(at(track, 0.999)[0], 10);
        EXPECT_EQ(at(track, 2)[0], 20);
        EXPECT_EQ(at(track, 1e9)[0], 20);
    }
    const Track cubic{Interpolation::cubic, 1, {1, 2}, {5, 10, 5, 7, 20, 7}};
    EXPECT_EQ(at(cubic, 0)[0], 10);
    EXPECT_EQ(at(cubic, 3)[0], 20);
    const Track single{Interpolation::linear, 1, {7}, {3}};
    for (const double t : {0.0, 7.0, 8.0}) EXPECT_EQ(at(single, t)[0], 3);
}

// A cubic through two keys with two tangents is the one polynomial that has them: x^3 over [1, 3].
TEST(Track, CubicIsThePolynomialOfItsTangents) {
    const auto tangent = [](float x) { return 3 * x * x; };
    const Track track{Interpolation::cubic, 1, {1, 3}, {-99, 1, tangent(1), tangent(3), 27, -99}};
    for (double x = 1; x <= 3; x += 0.125) EXPECT_NEAR(at(track, x)[0], x * x * x, 1e-12) << x;
}

TEST(Track, RotationsTurnAtAnEvenPace) {
    const Track track = turns({0, 1}, {about_y(0), about_y(120)});
    for (double t = 0; t <= 1; t += 0.125) {
        const auto q = at(track, t, true);
        EXPECT_NEAR(degrees_about_y(q), 120 * t, 1e-4) << t;
        EXPECT_NEAR(q[1] * q[1] + q[3] * q[3], 1, 1e-14);
        EXPECT_EQ(q[0], 0);
        EXPECT_EQ(q[2], 0);
    }
}

// q and -q are one rotation: a key that changed its sign changes nothing, and 350 degrees are 10 the other way.
TEST(Track, RotationsGoTheShorterWay) {
    std::vector<float> flipped = about_y(120);
    for (float& x : flipped) x = -x;
    const Track track = turns({0, 1}, {about_y(0), flipped});
    EXPECT_NEAR(degrees_about_y(at(track, 0.5, true)), 60, 1e-4);
    EXPECT_NEAR(degrees_about_y(at(turns({0, 1}, {about_y(0), about_y(350)}), 0.5, true)), -5, 1e-4);
}

TEST(Track, RotationsNearlyTheSameOrOppositeStayFinite) {
    for (const double degrees : {0.0, 1e-5, 0.01, 179.999, 180.0, 360.0}) {
        const auto q = at(turns({0, 1}, {about_y(0), about_y(degrees)}), 0.5, true);
        double squares = 0;
        for (const double x : q) squares += x * x;
        EXPECT_NEAR(squares, 1, 1e-12) << degrees;
    }
}

TEST(Track, RotationsOfNoLengthTurnNothing) {
    const auto q = at(turns({0, 1}, {{0, 0, 0, 0}, {0, 0, 0, 0}}), 0.5, true);
    EXPECT_EQ(q, (std::vector<double>{0, 0, 0, 1}));
}

TEST(Track, CubicRotationsAreOfUnitLength) {
    Track track = turns({0, 1}, {{0, 0, 0, 0}, about_y(0), {0, 0, 0, 0}, {0, 0, 0, 0}, about_y(90), {0, 0, 0, 0}});
    track.interpolation = Interpolation::cubic;
    const auto q = at(track, 0.5, true);  // the mean of the two, drawn out to unit length: half the turn
    EXPECT_NEAR(degrees_about_y(q), 45, 1e-4);
    EXPECT_NEAR(q[1] * q[1] + q[3] * q[3], 1, 1e-14);
}

// Times are floats in the file but are asked for in double: late in a long clip, frames must not fall together.
TEST(Track, LateMomentsStayApart) {
    const Track track{Interpolation::linear, 1, {0, 65536}, {0, 65536}};
    EXPECT_EQ(at(track, 65535.0 + 1.0 / 4096)[0], 65535.0 + 1.0 / 4096);
}

TEST(Clip, LastsUntilItsLastKey) {
    EXPECT_EQ(Clip{}.duration(), 0);
    const Clip clip{.name = "", .tracks = {Track{Interpolation::step, 1, {0, 2.5f}, {0, 0}}, Track{Interpolation::step, 1, {1}, {0}}}, .channels = {}};
    EXPECT_EQ(clip.duration(), 2.5);
}

TEST(Transform, ScalesThenTurnsThenMoves) {
    const Transform transform{{10, 0, 0}, glm::angleAxis(glm::radians(90.0), glm::dvec3(0, 0, 1)), {2, 1, 1}};
    const glm::dvec3 p(transform.matrix() * glm::dvec4(1, 0, 0, 1));
    EXPECT_LE(glm::length(p - glm::dvec3(10, 2, 0)), 1e-12);
}

}  // namespace
}  // namespace myriad::scenes
