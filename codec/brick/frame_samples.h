#pragma once

#include "codec/brick/slab_team.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_importance.h"
#include "volume/resample/resample_slices.h"
#include "volume/system/scratch_file.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace tessera::codec {

/// A range of brick layers of a frame, given by its slices.
struct Slab {
    int first = 0, count = 0; ///< slices

    /// Indices [begin, end) of its bricks.
    std::pair<std::size_t, std::size_t> bricks(const volume::BrickGrid& grid) const;
    /// The brick grid of the slab alone.
    volume::BrickGrid grid(volume::BrickGrid whole) const;
};

/// The slab of one brick layer.
Slab layerOf(const volume::BrickGrid& grid, int layer);

/// Where frames larger than memory are stored.
struct SlabStore {
    int layers = 1;           ///< brick layers in memory at a time
    std::string folder;       ///< directory for scratch files
    SlabTeam* team = nullptr; ///< processes that share the slabs; null: there is only this one
};

/// One component at one time, to be written to an archive: a field in memory, or, if larger than memory or shared by
/// processes, samples and flags in scratch files that are processed slab by slab. A field is a single slab.
class FrameSamples {
public:
    /// Refers to the field without copying it: the field must outlive this object.
    FrameSamples(const volume::Field& field) : borrowed_(&field) {}
    FrameSamples(volume::Field&& field) : own_(std::move(field)) {}
    /// Takes a frame in memory, or writes it to a scratch file slab by slab, which the processes of a team share. Mask
    /// values become 0 or 1. Throws MachineError, Cancelled, and what reading throws.
    FrameSamples(volume::SlicedFrame frame, const volume::BrickGrid& grid, const SlabStore& store,
                 const Progress& progress);

    /// The field; null for a frame in a scratch file.
    const volume::Field* whole() const { return borrowed_ ? borrowed_ : own_ ? &*own_ : nullptr; }
    /// Null for a frame in memory.
    const SlabStore* store() const { return stored_ ? &stored_->store : nullptr; }
    /// Processes that share the slabs, or null.
    SlabTeam* team() const { return stored_ ? stored_->store.team : nullptr; }
    std::size_t slabCount() const;
    Slab slab(std::size_t number) const;

    volume::ScalarType type() const { return whole() ? whole()->type : stored_->type; }
    const volume::Lattice& lattice() const { return whole() ? whole()->lattice : stored_->lattice; }
    double offset() const { return whole() ? whole()->offset : stored_->offset; }
    double scale() const { return whole() ? whole()->scale : stored_->scale; }
    std::size_t count() const { return lattice().count(); }
    /// Whether any sample may be absent.
    bool masked() const { return whole() ? whole()->mask != nullptr : stored_->masked; }

    /// Visits the slabs in order until `visit` returns false; returns true if none did.
    bool forSlabs(const std::function<bool(const volume::Field& part, Slab slab)>& visit) const;
    /// What `of` gives for each slab, in their order; by all processes of a team, where `step` says what is computed.
    template <class T>
    std::vector<T> ofSlabs(const char* step, const std::function<T(const volume::Field& part, Slab slab)>& of) const {
        const Pieces pieces = team() ? team()->pieces(step) : Pieces(piecesHere);
        volume::Field part;
        return valuesOf<T>(pieces, slabCount(), [&](std::size_t number) {
            if (whole()) return std::vector<T>{of(*whole(), slab(number))};
            take(slab(number).first, slab(number).count, part);
            return std::vector<T>{of(part, slab(number))};
        });
    }
    /// Modifies samples, flags, offset and scale slab by slab; offset and scale must be equal in all slabs. Of a team,
    /// one process visits a slab.
    void change(const std::function<void(volume::Field& part, Slab slab)>& visit);
    /// A copy with other samples, offset and scale: what `of` gives for each slab, offset and scale alike in all of
    /// them. Of a team, one process makes a slab; `step` says what.
    FrameSamples changed(const char* step, const std::function<volume::Field(volume::Field part, Slab slab)>& of) const;
    /// A range of slices as a field.
    volume::Field slices(int first, int count) const;
    /// The same in place of another field, whose memory is used again.
    void take(int first, int count, volume::Field& part) const;
    /// Reads the `n` samples from `at` on, and their flags unless `present` is null.
    void read(std::size_t at, std::size_t n, std::byte* samples, std::uint8_t* present) const;

private:
    FrameSamples() = default;

    struct Stored {
        volume::Lattice lattice;
        volume::ScalarType type{};
        double offset = 0, scale = 1;
        bool masked = false;
        SlabStore store;
        int slices = 0; ///< slices per slab
        /// The samples, then one flag each: of the frame, or of each slab, which a process of the team wrote.
        std::unique_ptr<volume::ScratchFile> file;
        std::vector<std::unique_ptr<const volume::ScratchFile>> slabs;
        std::vector<std::uint8_t> maskedSlabs; ///< whether those have flags

        std::size_t slabCount() const;
        Slab slab(std::size_t number) const;
        void put(const volume::Field& part, int first);
        /// Replaces the frame by the slabs that `part` gives.
        void fill(const char* step, const std::function<volume::Field(Slab slab)>& part);
        void fillTogether(const char* step, const std::function<volume::Field(Slab slab)>& part);
    };
    const volume::Field* borrowed_ = nullptr;
    std::optional<volume::Field> own_;
    std::unique_ptr<Stored> stored_;
};

/// volume::importanceOfBricks of a frame.
std::vector<volume::BrickImportance> importanceOfBricks(const volume::BrickGrid& grid, const FrameSamples& samples,
                                                        Range range, bool categorical,
                                                        const volume::ImportanceOptions& options);

} // namespace tessera::codec
