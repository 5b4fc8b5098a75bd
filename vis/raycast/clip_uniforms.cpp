#include "vis/raycast/clip_uniforms.h"

#include <algorithm>

namespace tessera::vis {

void addClipping(ProgramRecipe& recipe, const Scene& scene) {
    const std::vector<PlacedClip> clips = placeClips(scene.clips, {});
    const bool any = std::any_of(clips.begin(), clips.end(), [](const PlacedClip& clip) { return clip.hole; });
    recipe.defines.emplace_back("CLIPS", std::to_string(clips.size()));
    recipe.defines.emplace_back("CLIP_KIND(i)", choice(clips, [](const PlacedClip& clip) { return clip.kind; }));
    recipe.defines.emplace_back("CLIP_HOLE(i)", choice(clips, [](const PlacedClip& clip) { return clip.hole; }));
    recipe.defines.emplace_back("CLIP_HOLES", any ? "1" : "0");
}

void setClipUniforms(const Program& program, const Scene& scene, const WorldFrame& frame) {
    std::vector<glm::vec3> centers, axes, halves;
    for (const PlacedClip& clip : placeClips(scene.clips, frame)) {
        centers.emplace_back(clip.center);
        axes.emplace_back(clip.axis);
        halves.emplace_back(clip.half);
    }
    program.set("clipCenter", centers);
    program.set("clipAxis", axes);
    program.set("clipHalf", halves);
}

} // namespace tessera::vis
