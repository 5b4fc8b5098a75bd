#pragma once

#include "app/queries/async_query.h"
#include "vis/passes/renderer.h"

#include <memory>
#include <optional>
#include <string>

/// Difference of the values of the first layer's parameter between two variants of a comparison: variant minus
/// reference, in their unit, at the same position, drawn on the three planes through the cross-hair.
namespace tessera::app {

/// The first layers' parameters of a variant and of the reference.
struct CompareQuery {
    std::shared_ptr<const volume::BrickSource> own, reference;
    std::string channel, referenceChannel;
    double time = 0, referenceTime = 0;
    bool operator==(const CompareQuery&) const = default;
    bool sameData(const CompareQuery& other) const { return own == other.own && reference == other.reference; }
};

/// A session and the data it shows.
struct CompareSide {
    const Session& session;
    std::shared_ptr<const volume::BrickSource> source;
};

CompareQuery compareQuery(const CompareSide& own, const CompareSide& reference);

class CompareValues {
public:
    /// Finds the difference, in the background under `jobKey` unless headless. Sets context.answers.awaiting while it
    /// is on its way.
    void find(ViewContext& context, const std::string& jobKey, const CompareSide& own, const CompareSide& reference);
    /// Draws it in diverging colours from -top to top; false while there is nothing to show.
    bool draw(ViewContext& context, const Session& session, double top, glm::ivec2 size, bool moving);

    /// "T", "K": of the parameter; "" while not known.
    std::string name() const;
    std::string unit() const;
    /// The largest difference either way, 0 while not known.
    double largest() const;
    /// Why there is none: not the same unit, or nothing that differs.
    std::string failure() const { return found_ ? found_->result.failure : query_.failure(); }
    vis::TextureName texture() const { return status_.texture; }
    bool hasRenderer() const { return renderer_ != nullptr; }

private:
    struct Found {
        std::shared_ptr<const volume::BrickSource> difference; ///< null: see failure
        std::string failure;
    };
    const volume::BrickSource* difference() const { return found_ ? found_->result.difference.get() : nullptr; }

    AsyncQuery<CompareQuery, Found> query_{{.answers = 1}};
    std::shared_ptr<const AsyncQuery<CompareQuery, Found>::Answer> found_;
    std::shared_ptr<const volume::BrickSource> drawnOf_;
    std::unique_ptr<vis::Renderer> renderer_;
    vis::ViewTargetPtr target_;
    vis::FrameStatus status_;
};

} // namespace tessera::app
