#include "scenes/environment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "engine/error.hpp"
#include "scenes/scene.hpp"

namespace myriad::scenes {
namespace {

using glm::dvec3;
constexpr double pi = std::numbers::pi;

double luminance(const glm::vec3& c) { return 0.2126 * double(c.r) + 0.7152 * double(c.g) + 0.0722 * double(c.b); }

// The share of [from, to] that lies in texel i of an axis.
double covered(double from, double to, uint32_t i) { return std::max(0.0, std::min(to, i + 1.0) - std::max(from, double(i))); }

struct Cell {
    double column0, column1, row0, row1;
};

class Splitter {
public:
    Splitter(const Environment& environment, uint32_t seed) : environment_(environment), random_(seed) {
        for (uint32_t y = 0; y < environment.height; ++y) solid_angles_.push_back(environment.solid_angle(y));
        weights_.reserve(environment.texels.size());
        for (size_t i = 0; i < environment.texels.size(); ++i) weights_.push_back(float(luminance(environment.texels[i])));
    }

    double total() const {
        double sum = 0;
        for (size_t i = 0; i < weights_.size(); ++i) sum += double(weights_[i]) * solid_angles_[i / environment_.width];
        return sum;
    }

    void split(const Cell& cell, uint32_t count, std::vector<EnvironmentCell>& out) {
        if (count == 1) return out.push_back(finish(cell));
        const double middle = 0.5 * (cell.row0 + cell.row1) / environment_.height * pi;
        const double width = (cell.column1 - cell.column0) / environment_.width * 2 * pi * std::sin(middle);
        const double height = (cell.row1 - cell.row0) / environment_.height * pi;
        const uint32_t first = count / 2;
        Cell a = cell, b = cell;
        if (width > height) a.column1 = b.column0 = place(columns(cell), cell.column0, cell.column1, double(first) / count);
        else a.row1 = b.row0 = place(rows(cell), cell.row0, cell.row1, double(first) / count);
        split(a, first, out);
        split(b, count - first, out);
    }

private:
    // What a cell holds, row by row and column by column, from the first that it touches; whole texels' worth at the ends.
    std::vector<double> rows(const Cell& cell) const {
        std::vector<double> sums;
        for (uint32_t y = uint32_t(cell.row0); y < cell.row1; ++y) {
            double sum = 0;
            for (uint32_t x = uint32_t(cell.column0); x < cell.column1; ++x) sum += covered(cell.column0, cell.column1, x) * weight(x, y);
            sums.push_back(sum * solid_angles_[y]);
        }
        return sums;
    }
    std::vector<double> columns(const Cell& cell) const {
        const uint32_t first = uint32_t(cell.column0);
        std::vector<double> sums(size_t(std::ceil(cell.column1)) - first, 0);
        for (uint32_t y = uint32_t(cell.row0); y < cell.row1; ++y) {
            const double share = covered(cell.row0, cell.row1, y) * solid_angles_[y];
            for (size_t i = 0; i < sums.size(); ++i) sums[i] += share * weight(first + uint32_t(i), y);
        }
        return sums;
    }

    // Where this share of an axis' sums between two places is reached; the middle where there is nothing.
    static double place(const std::vector<double>& sums, double from, double to, double share) {
        const uint32_t first = uint32_t(from);
        double total = 0;
        for (size_t i = 0; i < sums.size(); ++i) total += sums[i] * covered(from, to, first + uint32_t(i));
        if (!(total > 0)) return 0.5 * (from + to);
        double left = share * total;
        for (size_t i = 0; i < sums.size(); ++i) {
            const double begin = std::max(from, double(first + i)), here = sums[i] * covered(from, to, first + uint32_t(i));
            if (left <= here && here > 0) return std::clamp(begin + left / sums[i], from, to);
            left -= here;
        }
        return to;
    }

    EnvironmentCell finish(const Cell& cell) {
        EnvironmentCell out{cell.column0, cell.column1, cell.row0, cell.row1, 0, dvec3(0), dvec3(0)};
        for (uint32_t y = uint32_t(cell.row0); y < cell.row1; ++y) {
            const double share = covered(cell.row0, cell.row1, y) * solid_angles_[y];
            for (uint32_t x = uint32_t(cell.column0); x < cell.column1; ++x) {
                const double solid_angle = share * covered(cell.column0, cell.column1, x);
                out.solid_angle += solid_angle;
                out.irradiance += solid_angle * dvec3(environment_.texels[size_t(y) * environment_.width + x]);
            }
        }
        // A row by what it holds, then a column of that row.
        const double row = place(rows(cell), cell.row0, cell.row1, uniform());
        const double in_row = std::min(std::floor(row), std::ceil(cell.row1) - 1);
        const double column = place(columns({cell.column0, cell.column1, in_row, in_row + 1}), cell.column0, cell.column1, uniform());
        out.towards = environment_.direction(column, row);
        return out;
    }

    double weight(uint32_t x, uint32_t y) const { return weights_[size_t(y) * environment_.width + x]; }
    double uniform() { return (double(random_()) + 0.5) / 4294967296.0; }

    const Environment& environment_;
    std::vector<double> solid_angles_;  // by row, of a texel
    std::vector<float> weights_;
    std::mt19937 random_;
};

// Cosine of the polar angle at a row's upper edge.
double edge(uint32_t row, uint32_t height) { return std::cos(pi * row / height); }

}  // namespace

dvec3 Environment::direction(double column, double row) const {
    const uint32_t whole = std::min(uint32_t(row), height - 1);
    const double up = glm::mix(edge(whole, height), edge(whole + 1, height), row - whole), out = std::sqrt(std::max(0.0, 1 - up * up));
    const double turn = (column / width - 0.5) * 2 * pi - rotation;
    return {out * std::cos(turn), up, out * std::sin(turn)};
}

double Environment::solid_angle(uint32_t row) const { return 2 * pi / width * (edge(row, height) - edge(row + 1, height)); }

dvec3 Environment::irradiance(const dvec3& normal) const {
    dvec3 sum(0);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            sum += std::max(0.0, glm::dot(normal, direction(x + 0.5, y + 0.5))) * solid_angle(y) * dvec3(texels[size_t(y) * width + x]);
    return sum;
}

std::vector<EnvironmentCell> environment_cells(const Environment& environment, uint32_t count, uint32_t seed) {
    Splitter splitter(environment, seed);
    if (!(splitter.total() > 0)) throw InputError("'" + environment.name + "' is black all over and lights nothing; give another environment, or none");
    std::vector<EnvironmentCell> cells;
    cells.reserve(count);
    if (count > 0) splitter.split({0, double(environment.width), 0, double(environment.height)}, count, cells);
    return cells;
}

void apply_environment(Scene& scene, Environment environment, uint32_t count, uint32_t seed) {
    environment.solid_angles.clear();
    for (const EnvironmentCell& cell : environment_cells(environment, count, seed)) {
        Light light;
        light.type = Light::Type::directional;
        light.name = "environment " + std::to_string(environment.solid_angles.size());
        light.direction = -glm::vec3(cell.towards);
        light.intensity = glm::vec3(cell.irradiance);
        scene.lights.push_back(light);
        environment.solid_angles.push_back(float(cell.solid_angle));
    }
    scene.environment = std::move(environment);
}

}  // namespace myriad::scenes
