#include "codec/archive/frame_coding.h"

#include "codec/brick/predicted_brick.h"
#include "codec/brick/subsamples.h"
#include "codec/brick/whole_brick.h"

namespace tessera::codec {

std::vector<std::uint32_t> FrameCoding::prediction(std::size_t b) const {
    if (!frame.predicted || before->depth[b] >= mostPredicted) return {};
    BrickInput was;
    was.take(grid, grid.indexOf(b), before->field, false);
    return predictionFrom(frame.numbers, before->field.type, was.samples);
}

std::vector<Bytes> FrameCoding::code(std::size_t b, const volume::Field& part, const volume::BrickGrid& own,
                                     std::size_t ownNumber, const BandEncoder& encoder, Compressor& compressor,
                                     BrickInput& input, SplitMemory& memory) {
    const glm::ivec3 brick = grid.indexOf(b);
    std::vector<Bytes> segments;
    FrameBrick& about = frame.bricks[b];
    whole[b] = 1;
    if (repeated[b] != 0) {
        about = before->bricks[b];
        about.notes.repeats += step;
        about.histogram = {};
        segments.resize(std::size_t(grid.levels));
        seen.bytes[b] = before->bytes[b];
        seen.depth[b] = before->depth[b];
        input.take(grid, brick, before->field, false);
    } else {
        const BrickFormat format = brickFormat(grid, brick, part.type, frame);
        input.take(own, own.indexOf(ownNumber), part, frame.mask >= 0);
        if (frame.parted) input.takeParts(grid, grid.begin(brick), format.size, *parts);
        const std::vector<std::uint32_t> from = prediction(b);
        if (!taken.bricks[b])
            taken.bricks[b] = prepareBrick(format, input.samples, input.present, maxError, model.contexts, memory, from,
                                           format.isStepped() ? nullptr : &model.fitted,
                                           frame.parted ? input.parts : std::vector<std::uint8_t>());
        segments = encodeBrick(format, *taken.bricks[b], input.samples, input.present, compressor, encoder);
        whole[b] = !segments[0].empty() && isWhole(segments[0][0]) ? 1 : 0;
        mixed[b] = whole[b] != 0 && isMixed(segments[0][0]) ? 1 : 0;
        roundAsDecoded(format, maxError, taken.bricks[b]->decoded, input);
        if (format.subsampled) addSubsamples(format, input.samples, input.present, compressor, segments);
        seen.depth[b] = static_cast<std::uint8_t>(from.empty() ? 0 : before->depth[b] + 1);
        if (frame.predicted) segments[0].insert(segments[0].begin(), static_cast<std::byte>(seen.depth[b]));
        for (const Bytes& segment : segments) seen.bytes[b] += segment.size();
        about = statisticsOf(part, input, statistics);
    }
    if (measures()) {
        BrickInput wanted;
        wanted.take(own, own.indexOf(ownNumber), part, frame.mask >= 0);
        errors[b] = errorsOf(part.type, input, wanted);
    }
    taken.bricks[b].reset();
    about.notes.importance = importance[b];
    if (keeps) {
        putSamples(grid, brick, input.samples, seen.field);
        if (before) about.notes.change = volume::changeOfBrick(grid, brick, before->field, seen.field);
    }
    return segments;
}

std::pair<double, double> FrameCoding::squares() const {
    double own = 0, ofRepeats = 0; // brick by brick, so that slabs give the same sums
    for (std::size_t b = 0; b < errors.size(); ++b) (repeated[b] != 0 ? ofRepeats : own) += errors[b].squares;
    return {own, ofRepeats};
}

bool FrameCoding::restart(double quantum) {
    if (!setQuantum(quantum, *steps)) return false;
    useSteps(*steps, frame);
    maxError = steps->maxError;
    seen.bytes.assign(seen.bytes.size(), 0);
    return true;
}

void FrameCoding::restartRounded(double bound) {
    steps.reset();
    samples = rounded.samples;
    before = rounded.before;
    repeated = rounded.repeated;
    seen.field.offset = samples->offset();
    seen.field.scale = samples->scale();
    std::vector<FrameBrick> bricks = std::move(frame.bricks);
    std::vector<Segment> segments = std::move(frame.segments);
    frame = rounded.frame;
    frame.bricks = std::move(bricks);
    frame.segments = std::move(segments);
    maxError = bound;
    seen.bytes.assign(seen.bytes.size(), 0);
}

} // namespace tessera::codec
