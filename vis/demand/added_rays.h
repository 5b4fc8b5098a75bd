#pragma once

#include "vis/packet/packet_renderer.h"
#include "vis/raycast/tile.h"
#include "vis/scene/scene.h"

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

/// Which pixels of a picture need more rays than their first: the mean of all rays of a pixel is known from first rays
/// alone where these lie on a smooth surface over the picture.
///
/// Around a pixel, the first rays of 3x3 pixels give a polynomial of second degree, whose mean at the places of all
/// rays is the pixel's predicted colour. Blocks of 4x4 pixels get all rays where a pixel, or one beside it, differs
/// from the mean of two opposite neighbours by more than kAlike; and one block of seventeen, in a pattern that every
/// line of blocks meets. Where the mean of all rays then differs from the predicted one by more than that, the blocks
/// around get theirs too, and so on: thin lines are followed from any place where a ray has met them. Differences are
/// those of the colours that a screen shows, over the ground.
///
/// Where choosing cannot gain, all rays are cast: in a group of 8x8 blocks most of whose blocks that show anything are
/// chosen, in all that do; and everywhere with depth of field, and where all that is drawn is strokes and grain.
namespace tessera::vis {

class AddedRays {
public:
    static constexpr float kAlike = 0.02f; ///< of the brightness of the screen
    static constexpr int kBlock = 4;       ///< pixels along the edge of a block; blocks begin with the area
    static constexpr int kGroup = 32;      ///< along that of a group of blocks; groups begin with the area

    /// Begins an area of a picture of `size` pixels, without any rays.
    void begin(const Scene& scene, glm::ivec2 size, const Tile& area);
    /// Whether this area was begun.
    bool holds(glm::ivec2 size, const Tile& area) const { return size_ == size && area_ == area; }
    /// Takes the first rays of a tile of the area; where `picture` has no pixels they meet nothing.
    void takeFirst(const packet::PacketPicture& picture, const Tile& tile);
    /// Chooses blocks of a tile by the first rays of all pixels, and predicts the colours of the others; false if that
    /// was done. The edges of a tile, here and below, are those of groups, or of the area.
    bool choose(const Tile& tile);
    /// The chosen blocks of a tile that lack rays; those of a whole group as one box.
    std::vector<packet::PixelBox> blocks(const Tile& tile) const;
    /// Takes ray `pass` > 0 of the pixels of these blocks.
    void take(const packet::PacketPicture& picture, const Tile& tile, int pass);
    /// After all rays of the chosen blocks: chooses those around pixels that differ from what was predicted. Returns
    /// whether there are any.
    bool chooseMore();
    /// Makes `out` the picture of a tile as far as it is known: means of the rays taken, or predicted.
    void show(const Tile& tile, packet::PacketPicture& out) const;
    /// The share of the area's blocks that were chosen.
    double share() const;

private:
    enum class State : std::uint8_t { Open, Predicted, Chosen, Done };
    struct Seen { ///< of the scene
        float bound = 0;
        glm::vec3 ground{0}; ///< linear
        bool showGround = true;
        Tone tone;
    };

    std::size_t at(glm::ivec2 pixel) const;
    Tile pixelsOf(const Tile& blocks) const;
    Tile pixelsOf(glm::ivec2 block) const { return pixelsOf(Tile{block, block + 1}); }
    Tile blocksOf(const Tile& pixels) const;
    State& state(glm::ivec2 block);
    State state(glm::ivec2 block) const;
    glm::vec4 shown(const glm::vec4& rgba) const;
    using Nine = std::array<glm::vec4, 9>;
    bool isEmpty(const Tile& pixels) const;
    Nine nine(const std::vector<glm::vec4>& of, glm::ivec2 pixel) const;
    glm::vec4 around(const std::vector<glm::vec4>& of, glm::ivec2 pixel) const;
    glm::vec4 predicted(glm::ivec2 pixel) const;
    bool standsOut(glm::ivec2 pixel) const;
    void setChosen(glm::ivec2 block);
    void chooseDense(const Tile& group);
    bool besidePredicted(glm::ivec2 block) const;

    glm::ivec2 size_{0};
    Tile area_;
    glm::ivec2 count_{0}; ///< of blocks
    Seen seen_;
    glm::vec2 mean_{0}, squares_{0}; ///< means of x, y and of their squares over the places of all rays in a pixel
    float product_ = 0;              ///< mean of x y
    /// Of the area's pixels: their first ray and its colour on a screen, and what is known; else as in pictures.
    std::vector<glm::vec4> first_, shown_, now_;
    std::vector<State> states_; ///< of blocks
};

} // namespace tessera::vis
