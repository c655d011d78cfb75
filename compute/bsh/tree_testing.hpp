// Trees of random triangles for tests, on the device. Tests only; the product never includes it.
#pragma once

#include "compute/bsh/bsh.hpp"
#include "compute/views/view_testing.hpp"
#include "engine/testing.hpp"

namespace myriad::compute {

struct Soup {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec4> triangles;
};

class TreeTest : public engine::DeviceTest {
protected:
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    glm::vec3 point(float scale = 1) { return glm::vec3(uniform(), uniform(), uniform()) * scale; }
    // `right_angles`: the frustum's half-angle; exact at 1 and 2.
    static View view(const glm::vec3& position, const glm::vec3& direction, float right_angles) {
        return compute::view(position, direction, right_angles * (std::numbers::pi_v<float> / 2));
    }

    Soup random_soup(size_t triangles, float size = 0.1f) {
        Soup soup;
        for (size_t i = 0; i < triangles; ++i) {
            const glm::vec3 middle = point();
            for (int k = 0; k < 3; ++k) soup.positions.push_back(middle + point(size));
            soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2, 0});
        }
        return soup;
    }
    Bsh build(const Soup& soup, uint32_t log2_samples, uint arity = bsh_arity_default) {
        Bsh tree(device, {soup.positions, soup.triangles}, log2_samples, 1, arity);
        if (tree.empty()) return tree;
        const auto positions = on_device(std::vector<vec3>(soup.positions));
        const auto triangles = on_device(std::vector<uvec4>(soup.triangles));
        engine::Recorder recorder(device);
        tree.refit(recorder, positions, triangles);
        recorder.submit_and_wait();
        return tree;
    }
};

}  // namespace myriad::compute
