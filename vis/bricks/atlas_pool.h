#pragma once

#include "vis/bricks/brick_atlas.h"
#include "vis/bricks/residency_options.h"

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace tessera::vis {

/// The brick atlases of one data set, grouped by texel components, within a memory budget.
class AtlasPool {
public:
    /// `reserve` throws MachineError if the driver lacks memory for that many more bytes; `say` receives messages.
    AtlasPool(const RendererOptions& options, const Driver& driver, std::function<void(std::size_t)> reserve,
              std::function<void(const std::string&)> say)
        : exact_(options.exactTextures), budget_(options.textureBudget), driver_(driver), reserve_(std::move(reserve)),
          say_(std::move(say)) {}

    /// Frees all atlases. Later ones hold bricks of a data set with this many bricks at full resolution.
    void clear(int brickSize, glm::ivec3 bricks);
    void setBudget(std::size_t bytes) { budget_ = bytes; }
    std::size_t bytes() const;
    bool exact() const { return exact_; }

    /// Picks the atlas for a new channel: one with free slots, else a new one within the budget, else the emptiest. A
    /// new atlas starts with slots for all bricks of one channel at all levels, no more: initialising texture memory is
    /// slow on software GL. Throws MachineError if the driver has no memory for the first atlas.
    BrickAtlas& atlasFor(int components);
    /// Replaces an atlas by a larger one, within the budget or, with `beyond`, above it; `move` copies the contents.
    /// Returns false if it cannot grow.
    bool grow(const BrickAtlas* atlas, bool beyond, const std::function<void(BrickAtlas& larger)>& move);

private:
    struct Atlas {
        std::unique_ptr<BrickAtlas> texture;
        std::size_t most; ///< limit of its growth in slots, within the budget
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
    std::size_t bricks_ = 0;                    ///< of a channel, at full resolution
    std::map<int, std::vector<Atlas>> atlases_; ///< by number of components
};

} // namespace tessera::vis
