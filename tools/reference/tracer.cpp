#include "tools/reference/tracer.hpp"

#include <embree3/rtcore.h>

#include <cstring>
#include <limits>
#include <new>

#include "engine/error.hpp"
#include "tools/reference/sampler.hpp"

namespace myriad::reference {
namespace {

struct Context {
    RTCIntersectContext embree;  // first: Embree hands out its address
    uint32_t dice;
};

struct Part {
    std::vector<uint32_t> ids;  // of its triangles
    const Surfaces* surfaces;
};

void decide(const RTCFilterFunctionNArguments* a) {
    if (a->valid[0] != -1) return;
    const Part& part = *static_cast<const Part*>(a->geometryUserPtr);
    const uint32_t triangle = part.ids[RTCHitN_primID(a->hit, a->N, 0)];
    const float opacity = part.surfaces->opacity(triangle, RTCHitN_u(a->hit, a->N, 0), RTCHitN_v(a->hit, a->N, 0));
    const uint32_t dice = reinterpret_cast<const Context*>(a->context)->dice;
    if (!(Sampler::unit(Sampler::mixed(dice ^ Sampler::mixed(triangle))) < opacity)) a->valid[0] = 0;
}

}  // namespace

struct Tracer::Embree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    Part parts[2];  // opaque, partial

    ~Embree() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
    void check() const {
        if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
            throw OutOfMemory("there is no memory for the tree of the reference's rays; give a smaller scene, or more memory");
    }
    void add(unsigned id, const scenes::Triangles& triangles) {
        Part& part = parts[id];
        if (part.ids.empty()) return;
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), triangles.positions.size()));
        auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), part.ids.size()));
        check();
        std::memcpy(positions, triangles.positions.data(), triangles.positions.size() * sizeof(vec3));
        for (const uint32_t i : part.ids)
            for (int k = 0; k < 3; ++k) *indices++ = triangles.triangles[i][k];
        if (id == 1) {
            rtcSetGeometryUserData(geometry, &part);
            rtcSetGeometryIntersectFilterFunction(geometry, decide);
            rtcSetGeometryOccludedFilterFunction(geometry, decide);
        }
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, id);
        rtcReleaseGeometry(geometry);
    }
};

Tracer::Tracer(const scenes::Triangles& triangles, const Surfaces& surfaces) : embree_(std::make_unique<Embree>()) {
    Embree& e = *embree_;
    e.device = rtcNewDevice("threads=1");
    if (!e.device) throw DeviceError("Embree does not start on this machine; it needs an x86-64 or ARM64 processor and a little memory");
    e.scene = rtcNewScene(e.device);
    rtcSetSceneFlags(e.scene, RTC_SCENE_FLAG_ROBUST);  // no ray slips through where triangles meet
    for (Part& part : e.parts) part.surfaces = &surfaces;
    for (uint32_t i = 0; i < surfaces.count(); ++i) e.parts[surfaces.partial(i)].ids.push_back(i);
    for (const unsigned id : {0u, 1u}) e.add(id, triangles);
    rtcCommitScene(e.scene);
    e.check();
}

Tracer::~Tracer() = default;

std::optional<Hit> Tracer::closest(const vec3& origin, const vec3& direction, uint32_t dice) const {
    Context context{.embree = {}, .dice = dice};
    rtcInitIntersectContext(&context.embree);
    RTCRayHit r{};
    r.ray.org_x = origin.x, r.ray.org_y = origin.y, r.ray.org_z = origin.z;
    r.ray.dir_x = direction.x, r.ray.dir_y = direction.y, r.ray.dir_z = direction.z;
    r.ray.tfar = std::numeric_limits<float>::infinity();
    r.ray.mask = ~0u;
    r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_->scene, &context.embree, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return Hit{embree_->parts[r.hit.geomID].ids[r.hit.primID], r.hit.u, r.hit.v};
}

bool Tracer::occluded(const vec3& origin, const vec3& way, float part, uint32_t dice) const {
    Context context{.embree = {}, .dice = dice};
    rtcInitIntersectContext(&context.embree);
    RTCRay r{};
    r.org_x = origin.x, r.org_y = origin.y, r.org_z = origin.z;
    r.dir_x = way.x, r.dir_y = way.y, r.dir_z = way.z;
    r.tfar = part;
    r.mask = ~0u;
    rtcOccluded1(embree_->scene, &context.embree, &r);
    return r.tfar < 0;
}

}  // namespace myriad::reference
