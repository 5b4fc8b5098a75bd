#pragma once

#include "vis/bricks/brick_atlas.h"
#include "vis/bricks/residency_options.h"

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace tessera::vis {

/// The atlases of bricks of one data set, by components of their texels, within a budget.
class AtlasPool {
public:
    /// `reserve` throws MachineError where the driver has no memory for so many bytes more; `say` takes messages.
    AtlasPool(const RendererOptions& options, const Driver& driver, std::function<void(std::size_t)> reserve,
              std::function<void(const std::string&)> say)
        : exact_(options.exactTextures), budget_(options.textureBudget), driver_(driver), reserve_(std::move(reserve)),
          say_(std::move(say)) {}

    /// Drops all atlases; the next ones hold bricks of a data set that has so many at full resolution.
    void clear(int brickSize, glm::ivec3 bricks);
    void setBudget(std::size_t bytes) { budget_ = bytes; }
    std::size_t bytes() const;
    bool exact() const { return exact_; }

    /// An atlas for a new channel: one with room, a further one if the budget allows, else the emptiest. It begins with
    /// room for every brick of one channel at every level: texture memory is dear to set up without a GPU. Throws
    /// MachineError when the driver has no memory for the first one.
    BrickAtlas& atlasFor(int components);
    /// Puts a larger atlas in the place of one, within the budget or `beyond` it; `move` copies what is in it. False
    /// when there is no more room.
    bool grow(const BrickAtlas* atlas, bool beyond, const std::function<void(BrickAtlas& larger)>& move);

private:
    struct Atlas {
        std::unique_ptr<BrickAtlas> texture;
        std::size_t most; ///< slots that it may grow to within the budget
    };
    std::size_t slotBytes(int components) const;
    std::unique_ptr<BrickAtlas> make(int components, std::size_t slots);
    bool grow(int components, Atlas& atlas, bool beyond, const std::function<void(BrickAtlas& larger)>& move);

    bool exact_;
    std::size_t budget_;
    Driver driver_;
    std::function<void(std::size_t)> reserve_;
    std::function<void(const std::string&)> say_;
    int brickSize_ = 1;
    std::size_t bricks_ = 0;                    ///< of a channel at full resolution
    std::map<int, std::vector<Atlas>> atlases_; ///< by components
};

} // namespace tessera::vis
