#pragma once

#include "codec/blocks/shared_job.h"
#include "codec/brick/slab_team.h"

#include <cstddef>
#include <string>

namespace tessera::codec {

/// The processes of a job that pack one piece of it together.
class SharedSlabs : public SlabTeam {
public:
    /// `piece`: its name in the job, which must outlive this object.
    SharedSlabs(const SharedJob& job, const std::string& piece, bool writes, const Progress& progress);

    std::vector<SharedResult> share(const std::string& step, std::size_t pieces,
                                    const std::function<void(std::size_t, const Write&)>& work) override;
    bool writes() const override { return writes_; }
    /// States that the piece has been packed, and removes what was shared.
    void end() const;
    /// Whether other processes have packed the piece. What this one still does for it may then fail.
    bool isOver() const;
    /// Waits a little for that, since another machine may see late that files have gone.
    bool endsSoon() const;

private:
    std::string overFile() const { return job_.scratch("over-" + piece_); }

    const SharedJob& job_;
    std::string piece_;
    bool writes_;
    Progress progress_; ///< reports nothing: steps are small parts of the piece
    std::size_t steps_ = 0;
};

} // namespace tessera::codec
