#pragma once

#include "app/data/sources.h"
#include "app/edits/compare.h"
#include "app/queries/async_query.h"
#include "app/queries/scene_query.h"
#include "app/views/compare/compare_values.h"
#include "vis/gl/plot_texture.h"
#include "vis/image/image_metrics.h"

#include <list>
#include <memory>
#include <optional>

/// Pictures of the variants of a comparison, and their difference from the reference. Variants of the same data are
/// drawn by the window's renderer; other data, opened in the background, by renderers of their own.
namespace tessera::app {

/// Data of a variant that differ from those of the session.
struct CompareData {
    struct Opened {
        Sources sources;
        std::string failure;
        std::vector<std::string> messages;
    };
    DataRef data;
    AsyncQuery<DataRef, Opened> opening;
    std::shared_ptr<const volume::BrickSource> source; ///< null while it opens
    /// Of numbers: the samples as computed, of packed data what the archive gives.
    std::shared_ptr<const volume::BrickSource> numbers;
    NumberOrigin origin;
    double packedBytes = 0; ///< of the archive that they were packed into
    std::unique_ptr<vis::Renderer> renderer;
    std::string failure;
    std::vector<std::string> messages; ///< from opening it, not yet shown
};

/// A picture and that of the reference, of one size.
struct PicturePair {
    std::shared_ptr<const vis::Image> image, reference;
    bool operator==(const PicturePair&) const = default;
};
struct PictureDifference {
    vis::ImageDifference of;
    std::vector<std::uint8_t> map; ///< differenceMap
};

struct CompareCell {
    CompareVariant variant;
    Session of, session;               ///< the session it was made from, and with the changes
    std::string failure;               ///< why there is no picture
    std::shared_ptr<CompareData> data; ///< null: the session's
    AsyncScene shapes;
    vis::ViewTargetPtr target;
    vis::FrameStatus status;
    bool drawn = false;
    // The scene and size of the picture that is there.
    bool shows = false;
    vis::Scene sceneShown;
    glm::ivec2 sizeShown{0};
    /// The target is that of other data: nothing must be shown of it while another one waits for its turn.
    void dropPicture() { target.reset(), status = {}, shows = false; }

    // Pixels of the finished picture, and the measures computed from them.
    vis::Scene imageOf;
    std::shared_ptr<const volume::BrickSource> imageSource;
    std::shared_ptr<const vis::Image> image;
    using Measuring = AsyncQuery<PicturePair, PictureDifference>;
    Measuring measuring{{.answers = 1}};
    std::shared_ptr<const Measuring::Answer> measured; ///< of its picture and the reference's

    // Comparison of the first layer's samples with the reference's: its inputs and result.
    AsyncQuery<CompareQuery, std::optional<volume::SourceDifference>> counting{{.answers = 1}};
    CompareQuery samplesOf;
    std::optional<volume::SourceDifference> samples;

    std::map<std::string, std::unique_ptr<ViewCache>> caches; ///< of a view shown instead of the scene

    vis::PlotTexture differencePicture;
    std::shared_ptr<const Measuring::Answer> shownOf; ///< what differencePicture shows
    double shownTop = -1;
    CompareValues values; ///< how far the first layer's values are from the reference's

    /// Drops the numbers of the variant that was here before.
    void forgetNumbers() {
        status = {};
        image.reset();
        measured.reset();
        samplesOf = {};
        samples.reset();
    }
    const std::shared_ptr<const volume::BrickSource>& source(const ViewContext& context) const {
        return data ? data->source : context.source;
    }
    const std::shared_ptr<const volume::BrickSource>& numbers(const ViewContext& context) const {
        return data ? data->numbers : context.numbers;
    }
    /// Whether its data, which are not the session's, are still being opened.
    bool isOpening() const { return failure.empty() && !(session.data == of.data) && !(data && data->source); }
    bool isMeasured() const { return measured && measured->query.image == image; }
    bool showsDifference() const { return shownOf && shownOf->query.image == image; }
    /// True if nothing is left to draw.
    bool final() const { return !failure.empty() || (drawn && status.complete); }
    bool finished() const { return drawn && status.complete && image; }
};

class ComparePictures {
public:
    /// Makes the session of each variant; before `draw`.
    void prepare(const ViewContext& context, const std::vector<CompareVariant>& variants);
    /// Opens the data of every variant and compares their samples, for views that draw the variants themselves.
    void open(ViewContext& context, const std::string& pane, std::size_t reference);
    /// Draws every variant at one size; index 0 is the first. Sets context.answers.busy while something is not final.
    void draw(ViewContext& context, const std::string& pane, std::size_t reference, glm::ivec2 size, bool moving);
    std::vector<std::shared_ptr<CompareCell>>& cells() { return cells_; }
    const std::vector<std::shared_ptr<CompareCell>>& cells() const { return cells_; }
    /// Number of renderers besides the window's.
    int renderers() const;
    /// The difference of 255 that is brightest: `top`, or the largest where `top` is 0.
    double differenceTop(double top) const;
    /// Fills the pictures of the differences, brightest at differenceTop.
    void showDifferences(vis::TexturesIn where, double top, std::size_t reference);
    /// Finds how the values of the first layers differ from the reference's; returns the largest difference of all.
    double findValues(ViewContext& context, const std::string& pane, std::size_t reference);
    /// The same, as far as it is found.
    double largestValue(std::size_t reference) const;
    /// The rows of the table, as far as they are known.
    std::vector<CompareRow> rows(const ViewContext& context, std::size_t reference) const;

private:
    std::shared_ptr<CompareData> dataFor(ViewContext& context, const std::string& pane, const DataRef& data);
    bool openCell(ViewContext& context, const std::string& pane, std::size_t index, bool alone);
    void drawCell(ViewContext& context, const std::string& pane, std::size_t index, glm::ivec2 size, bool moving);
    void dropUnused();
    void measure(ViewContext& context, const std::string& pane, std::size_t index, std::size_t reference);
    void measureSamples(ViewContext& context, const std::string& pane, std::size_t index, std::size_t reference);

    std::size_t refined_ = 0;                      ///< index of the cell being refined
    std::list<std::shared_ptr<CompareData>> data_; ///< before the cells: their targets go first
    std::vector<std::shared_ptr<CompareCell>> cells_;
};

} // namespace tessera::app
