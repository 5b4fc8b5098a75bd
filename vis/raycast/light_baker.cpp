#include "vis/raycast/light_baker.h"

#include "vis/raycast/clock.h"
#include "volume/base/background.h"

#include <algorithm>

namespace tessera::vis {

namespace {

bool sameSpread(const Shadows& a, const Shadows& b) {
    return (a.strength > 0) == (b.strength > 0) && (a.occlusion > 0) == (b.occlusion > 0) && a.reach == b.reach &&
           a.translucency == b.translucency && a.scatter == b.scatter;
}

} // namespace

LightBaker::MediumKey LightBaker::keyOf(const Scene& scene, const LightGrid& grid, const Medium& medium) {
    MediumKey key{scene, placeLenses(scene, {}), grid, medium};
    Scene& used = key.scene;
    used.lenses.clear(); // lenses that face the viewer or follow the cursor move without a change of the scene
    used.camera = {};
    used.cursor = glm::dvec3(0);
    used.time = 0; // part of `medium`
    used.render = {};
    used.render.filter = scene.render.filter;
    used.lighting = {};
    used.lighting.shadows.meshes = scene.lighting.shadows.meshes;
    used.tone = {};
    used.depthMask = {};
    used.strokes.clear();
    used.background = used.boxColor = glm::vec3(0);
    used.paper.reset();
    used.showGround = used.showBox = false;
    return key;
}

bool LightBaker::same(const Spread& a, const Spread& b) {
    return a.medium == b.medium && a.lights == b.lights && sameSpread(a.shadows, b.shadows);
}

bool LightBaker::ready() const {
    return version_ > 0 && same(wanted_, shown_);
}

void LightBaker::update(const Scene& scene, const volume::DatasetInfo& info, const Medium& medium,
                        const std::variant<Pass, Rows>& how, double budgetMs, bool wait) {
    const LightGrid grid = lightGrid(worldFrame(info, scene.stretch), scene.lighting.shadows);
    if (MediumKey key = keyOf(scene, grid, medium); mediumOf_ != key) {
        mediumOf_ = std::move(key);
        grid_ = grid;
        ++wanted_.medium;
        mediumReady_ = false;
        rows_ = 0;
        reader_.forget();
        casters_ = meshCasters(scene, info);
        casting_ = !casters_.casters.empty();
        worker_.request_stop();
        job_.reset();
    }
    wanted_.lights = placeLights(scene.lighting, scene.camera);
    wanted_.shadows = scene.lighting.shadows;
    if (const auto* rows = std::get_if<Rows>(&how)) {
        if (!mediumReady_ && !computeMedium(*rows, budgetMs, wait)) return;
    } else {
        if (!mediumReady_) drawMedium(std::get<Pass>(how), budgetMs, wait);
        if (!mediumReady_ && !readMedium(wait)) return;
    }
    // A running propagation is finished and shown even if a light has moved since, so that light updates while the
    // camera turns.
    while (true) {
        if (job_ && wait) worker_.join();
        if (job_ && job_->done) take();
        if (job_ || ready()) return;
        start();
        if (!wait) return;
    }
}

/// Draws some rows of the extinction; starts reading it back after the last one.
void LightBaker::drawMedium(const Pass& pass, double budgetMs, bool wait) {
    const Clock::time_point begin = Clock::now();
    const glm::ivec2 size(grid_.size.x, grid_.size.y * grid_.size.z);
    if (atlasSize_ != size) {
        atlas_ = makeTexture2D(size, kMediumFormat, GL_NEAREST, "medium of the light volume");
        framebuffer_ = makeFramebuffer({atlas_.name()}, "medium of the light volume");
        reader_.resize(grid_.count() * 4);
        atlasSize_ = size;
    }
    if (rows_ == size.y) return;
    pass.setUniforms(pass.program);
    pass.program.set("gridSize", grid_.size);
    pass.program.set("mediumSamples", kMediumSamples * kMediumSamples * kMediumSamples);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, size.x, size.y);
    glEnable(GL_SCISSOR_TEST);
    glUseProgram(pass.program.name());
    glBindVertexArray(pass.vertices);
    while (rows_ < size.y) {
        const int count = std::min(wait || !pass.waits ? size.y : 2 * grid_.size.y, size.y - rows_);
        glScissor(0, rows_, size.x, count);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        rows_ += count;
        if (pass.waits) glFinish();
        if (!wait && millisecondsSince(begin) > budgetMs) break;
    }
    if (rows_ < size.y) return;
    reader_.start(atlas_.name(), size, GL_RGBA);
    read_ = std::make_shared<vis::Medium<float>>(grid_.count());
}

/// Receives the extinction that was read back; false while it is pending.
bool LightBaker::readMedium(bool wait) {
    if (!reader_.pending() || !reader_.take({&read_->data()->x, read_->size() * 4}, wait)) return false;
    medium_ = std::move(read_);
    mediumReady_ = true;
    return true;
}

/// Computes some rows of the extinction; false while some are missing.
bool LightBaker::computeMedium(const Rows& rows, double budgetMs, bool wait) {
    const Clock::time_point begin = Clock::now();
    const int all = grid_.size.y * grid_.size.z, together = wait ? all : 2 * grid_.size.y;
    if (rows_ == 0) read_ = std::make_shared<vis::Medium<float>>(grid_.count());
    while (rows_ < all) {
        const int end = std::min(rows_ + together, all);
        rows(grid_, rows_, end, *read_);
        rows_ = end;
        if (!wait && millisecondsSince(begin) > budgetMs) break;
    }
    if (rows_ < all) return false;
    medium_ = std::move(read_);
    mediumReady_ = true;
    return true;
}

void LightBaker::start() {
    job_ = std::make_shared<Job>();
    job_->key = wanted_;
    job_->medium = medium_;
    worker_ =
        std::jthread([job = job_, grid = grid_, casters = casting_ ? casters_ : MeshCasters()](std::stop_token stop) {
            workInBackground();
            if (!casters.casters.empty()) {
                vis::Medium<float> sum = meshMedium<float>(grid, casters, stop);
                for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += (*job->medium)[i];
                job->medium = std::make_shared<const vis::Medium<float>>(std::move(sum));
            }
            job->result = std::make_shared<const LightVolume<float>>(
                spreadLight<float>(grid, *job->medium, job->key.lights, job->key.shadows, stop));
            job->done = !stop.stop_requested();
        });
}

/// Uploads the light of a finished job.
void LightBaker::take() {
    const LightVolume<float>& light = *job_->result;
    const glm::ivec3 size = light.grid.size;
    const bool other = !light_ || light_->grid.size != size;
    if (!visible_ || other) visible_ = makeTexture3D(size, GL_RGBA16, GL_LINEAR, "light volume");
    glTextureSubImage3D(visible_.name(), 0, 0, 0, 0, size.x, size.y, size.z, GL_RGBA, GL_FLOAT, light.visible.data());
    if (!light.scattered.empty()) {
        if (!scattered_ || other) scattered_ = makeTexture3D(size, GL_RGBA32F, GL_LINEAR, "scattered light");
        std::vector<glm::vec4> texels;
        for (const glm::vec3& each : light.scattered) texels.emplace_back(each, 0);
        glTextureSubImage3D(scattered_.name(), 0, 0, 0, 0, size.x, size.y, size.z, GL_RGBA, GL_FLOAT, texels.data());
    } else {
        scattered_ = {};
    }
    light_ = job_->result;
    shown_ = job_->key;
    medium_ = job_->medium;
    casting_ = false;
    job_.reset();
    ++version_;
}

} // namespace tessera::vis
