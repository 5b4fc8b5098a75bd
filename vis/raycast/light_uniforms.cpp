#include "vis/raycast/light_uniforms.h"

#include "vis/image/light_picture.h"
#include "vis/optics/shade.h"
#include "vis/optics/surface_light.h"

#include <algorithm>

namespace tessera::vis {

namespace {

void upload(Texture& texture, const CubeMap& map, const char* label) {
    if (!texture) texture = makeTextureCube(map.edge, GL_RGBA32F, label);
    std::vector<glm::vec4> texels;
    for (const glm::dvec3& each : map.texels) texels.emplace_back(each, 1);
    glTextureSubImage3D(texture.name(), 0, 0, 0, 0, map.edge, map.edge, 6, GL_RGBA, GL_FLOAT, texels.data());
}

} // namespace

void addLighting(ProgramRecipe& recipe, const Scene& scene) {
    const std::vector<PlacedLight> lights = ownLights(scene.lighting, scene.camera);
    const bool points = std::any_of(lights.begin(), lights.end(), [](const PlacedLight& light) { return light.point; });
    recipe.slots["shade"] =
        scene.lighting.model == LightModel::Phong ? "slots/shade_phong.glsl" : "slots/shade_physical.glsl";
    const Shadows& shadows = scene.lighting.shadows;
    recipe.defines.emplace_back("LIGHTS", std::to_string(lights.size() <= 2 ? int(lights.size()) : kMaxLights));
    recipe.defines.emplace_back("POINT_LIGHTS", points ? "1" : "0");
    recipe.defines.emplace_back("LIGHT_MAPS", usesMaps(scene.lighting) ? "1" : "0");
    recipe.defines.emplace_back("LIGHT_VOLUME", shadows.translucency > 0 ? "2" : shadows.any() ? "1" : "0");
}

void setLightUniforms(const Program& program, const Scene& scene, const WorldFrame& frame, int firstUnit) {
    const Lighting& lighting = scene.lighting;
    const std::vector<PlacedLight> lights = ownLights(lighting, scene.camera);
    std::vector<glm::vec4> places;
    std::vector<glm::vec3> colors;
    for (const PlacedLight& each : lights) {
        places.emplace_back(each.place, each.point ? 1 : 0);
        colors.emplace_back(each.color);
    }
    program.set("lightCount", int(places.size()));
    program.set("lightPlace", places);
    program.set("lightColor", colors);
    program.set("material",
                lighting.model == LightModel::Phong
                    ? glm::vec4(lighting.ambient, lighting.diffuse, lighting.specular, lighting.shininess)
                    : glm::vec4(lighting.ambient, lighting.roughness, lighting.metalness, lighting.reflectance));
    program.set("diffuseMap", firstUnit);
    program.set("specularMap", firstUnit + 1);
    program.set("lightVisible", firstUnit + 2);
    program.set("lightScattered", firstUnit + 3);
    program.set("mapShare", glm::vec2(lighting.diffuse, lighting.specular));
    program.set("mapFromWorld", glm::mat3(mapFromWorld(lighting, scene.camera)));
    program.set("shadowStrength", glm::vec2(lighting.shadows.strength, lighting.shadows.occlusion));
    const FlatShares shares = flatShares(lighting, lights);
    program.set("flatShares", glm::vec4(shares.lights, shares.everywhere));
    const glm::dvec3 cell = lightGrid(frame, lighting.shadows).cell();
    program.set("lightCell", float(std::max({cell.x, cell.y, cell.z})));
}

/// Reads the environment picture of a lighting; true once it is available or has failed.
bool LightMapTextures::readPicture(const Lighting& lighting, bool wait,
                                   const std::function<void(const std::string&)>& say) {
    const EnvironmentLight& environment = lighting.environment;
    if (environment.kind != Environment::Picture) return true;
    if (path_ != environment.picture && !reading_.valid()) {
        path_ = environment.picture;
        picture_.reset();
        madeFor_.reset();
        if (path_.empty()) return true;
        reading_ = std::async(std::launch::async, [path = path_] { return readSurroundings(path); });
    }
    if (!reading_.valid()) return true;
    if (!wait && reading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    try {
        picture_ = reading_.get();
    } catch (const std::exception& error) {
        say(std::string("The surroundings cannot be shown: ") + error.what());
    }
    madeFor_.reset();
    return path_ == environment.picture || readPicture(lighting, wait, say); // the path has changed meanwhile
}

bool LightMapTextures::update(const Lighting& lighting, const Camera& camera, bool wait,
                              const std::function<void(const std::string&)>& say) {
    const bool here = readPicture(lighting, wait, say);
    if (!here && diffuse_) return false;
    const bool same = madeFor_ && *madeFor_ == lighting && camera_.orientation == camera.orientation;
    if (same) return here;
    if (!madeFor_ || !sameEnvironment(*madeFor_, lighting))
        environment_ = environmentMaps(lighting, picture_ ? &*picture_ : nullptr);
    maps_ = std::make_shared<const LightMaps>(lightMaps(lighting, camera, environment_));
    upload(diffuse_, maps_->diffuse, "diffuse light");
    upload(specular_, maps_->specular, "mirrored light");
    madeFor_ = lighting;
    camera_ = camera;
    ++version_;
    return here;
}

} // namespace tessera::vis
