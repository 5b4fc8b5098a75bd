#include "codec/archive/coded_bricks.h"

#include <utility>

namespace tessera::codec {

CodedBricks::CodedBricks(std::size_t bricks, std::size_t segments, const std::string* folder) : segments_(segments) {
    if (folder) {
        file_ = std::make_unique<volume::ScratchFile>(*folder);
        places_.resize(bricks * segments);
    } else {
        bytes_.resize(bricks);
    }
}

void CodedBricks::clear() {
    end_ = 0; // the scratch file is overwritten
    for (std::vector<Bytes>& segments : bytes_) segments.clear();
}

void CodedBricks::put(std::size_t brick, std::vector<Bytes> segments) {
    if (!file_) {
        bytes_[brick] = std::move(segments);
        return;
    }
    for (std::size_t s = 0; s < segments_; ++s) {
        file_->write(end_, segments[s]);
        places_[brick * segments_ + s] = {end_, static_cast<std::uint32_t>(segments[s].size())};
        end_ += segments[s].size();
    }
}

Bytes CodedBricks::take(std::size_t brick, std::size_t segment) {
    if (!file_) return std::move(bytes_[brick][segment]);
    const Place& place = places_[brick * segments_ + segment];
    Bytes bytes(place.size);
    file_->read(place.offset, bytes);
    return bytes;
}

} // namespace tessera::codec
