#include "tests/codec/plain/bands.h"
#include "tests/codec/plain/fitted.h"
#include "tests/codec/plain/mixed.h"
#include "tests/codec/plain/steps.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tessera::codec::plain {

Size Decoder::fineSize(int number) const {
    const Size index{number % bricks_[0], number / bricks_[0] % bricks_[1], number / (bricks_[0] * bricks_[1])};
    Size size;
    for (std::size_t a = 0; a < 3; ++a) {
        const int covered = brickSize_ * (a == 2 && bcc_ ? 2 : 1);
        size[a] = std::min(size_[a] - index[a] * covered, covered);
    }
    return size;
}

/// 2
std::vector<bool> Decoder::fineFlags(const Frame& frame, int number, const Size& size) const {
    const std::size_t count = std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]);
    if (frame.mask < 0) return std::vector<bool>(count, true);
    const Mask& mask = masks_[std::size_t(frame.mask)];
    const std::uint32_t present = mask.present[std::size_t(number)];
    const Octets bytes = checked(mask.pieces[std::size_t(number)]);
    if (present == 0 || present == count) return std::vector<bool>(count, present != 0);
    Octets bits(bytes.begin() + 1, bytes.end());
    if (bytes[0] == 1) bits = unzstd(bits, (count + 7) / 8);
    std::vector<bool> flags;
    for (std::size_t i = 0; i < count; ++i) flags.push_back((bits[i / 8] >> (i % 8) & 1) != 0);
    return flags;
}

std::vector<std::size_t> Decoder::partsOf(std::size_t frame, int number) const {
    std::size_t component = frame % types_.size(), first = 0;
    const auto& parameters = metadata_["data"]["parameters"];
    const nlohmann::json* own = nullptr;
    for (const auto& parameter : parameters) {
        const std::size_t count = parameter["components"];
        if (component < count) {
            own = &parameter;
            break;
        }
        component -= count;
    }
    need(own && own->contains("parts"), "parts");
    const auto& regions = (*own)["parts"]["regions"];
    need(regions.size() >= 2 && regions.size() <= 7, "parts");
    for (const auto& parameter : parameters) {
        if (parameter["name"] == (*own)["parts"]["label"] && parameter["categorical"] && parameter["components"] == 1) {
            const Brick labels = brick(frame - frame % types_.size() + first, number, 0);
            std::vector<std::size_t> parts;
            for (std::size_t i = 0; i < labels.values.size(); ++i) {
                std::size_t part = 0;
                for (std::size_t r = regions.size(); labels.present[i] && r-- > 0;)
                    for (const auto& value : regions[r])
                        if (value == std::lround(labels.values[i])) part = r;
                parts.push_back(part);
            }
            return parts;
        }
        first += parameter["components"].get<std::size_t>();
    }
    need(false, "label");
    return {};
}

int Decoder::depth(std::size_t frame, int number) const {
    const std::size_t repeats = hasNotes_ ? frames_[frame].repeats[std::size_t(number)] * types_.size() : 0;
    const Frame& held = frames_[frame - repeats];
    return held.predicted ? checked(held.pieces[std::size_t(number)]).at(0) : 0;
}

std::size_t Decoder::place(std::size_t frame, int number) const {
    return frames_[frame].pieces[std::size_t(number)].offset;
}

Brick Decoder::brick(std::size_t frameNumber, int number, int level) const {
    const std::size_t repeats = hasNotes_ ? frames_[frameNumber].repeats[std::size_t(number)] * types_.size() : 0;
    need(repeats <= frameNumber, "repeats");
    const Frame& frame = frames_[frameNumber - repeats];
    need(repeats == 0 || frame.repeats[std::size_t(number)] == 0, "repeats");
    const std::string& type = types_[frameNumber % types_.size()];
    const Size fine = fineSize(number);
    const std::vector<bool> flags = fineFlags(frame, number, fine);
    const std::size_t bricks = std::size_t(bricks_[0]) * std::size_t(bricks_[1]) * std::size_t(bricks_[2]);
    const int sublattices = bcc_ ? 2 : 1;

    // The boxes of both sublattices at the wanted level, with flags where they are present.
    std::vector<Box> boxes;
    const std::vector<std::size_t> partOf(frame.parted ? partsOf(frameNumber - repeats, number)
                                                       : std::vector<std::size_t>());
    std::vector<std::size_t> own; // 4.13: those that have samples here
    for (std::size_t part = 0; part < 7 && frame.parted; ++part)
        for (std::size_t i = 0; i < flags.size(); ++i)
            if (flags[i] && partOf[i] == part) {
                own.push_back(part);
                break;
            }
    const int lanes = own.size() < 2 ? sublattices : int(own.size());
    for (int lane = 0; lane < lanes; ++lane) {
        const int s = own.size() < 2 ? lane : 0;
        const Size whole{fine[0], fine[1], (fine[2] + sublattices - 1 - s) / sublattices};
        Size size = whole;
        for (int l = 0; l < level; ++l) size = half(size);
        Box box = makeBox(size);
        places({0, 0, 0}, size, [&](const Size& p) {
            const int z = (p[2] << level) * sublattices + s;
            const std::size_t at =
                (std::size_t(z) * std::size_t(fine[1]) + std::size_t(p[1] << level)) * std::size_t(fine[0]) +
                std::size_t(p[0] << level);
            if (flags[at] && (own.size() < 2 || partOf[at] == own[std::size_t(lane)])) box.at(p) = 0u;
        });
        split(box, levels_ - 1 - level);
        boxes.push_back(std::move(box));
    }

    // 4.1: every coefficient to its place.
    std::vector<std::uint32_t> absentBits, exactIndex, exactBits;
    const auto extras = [&](Reader& in) {
        if (frame.keepsAbsent) {
            std::size_t absent = 0;
            for (const bool flag : flags) absent += flag ? 0 : 1;
            absentBits = stream(in, absent);
        }
        if (type == "float32" && frame.numbers != 2) {
            const std::size_t exact = in.u32();
            exactIndex = stream(in, exact);
            exactBits = stream(in, exact);
        }
    };
    const bool centred = frame.bodyCentred && bcc_ && levels_ > 1 && fine[2] > 1 && frame.numbers != 2 &&
                         std::find(flags.begin(), flags.end(), false) == flags.end();
    bool whole = false;
    std::vector<std::uint32_t> subsamples;
    std::optional<Brick> before; // 4.10
    std::vector<Octets> later;   // 4.8, 4.11: the segments
    const std::optional<Model> model =
        frame.numbers == 4 ? std::nullopt : std::optional(parseModel(models_[frame.model]));
    const bool fitted = model && model->fitted && levels_ > 1;
    std::vector<std::pair<std::size_t, std::int64_t>> corrections;
    for (int segment = 0; segment < levels_ - level; ++segment) {
        const Octets bytes = checked(frame.pieces[std::size_t(segment) * bricks + std::size_t(number)]);
        Reader in(bytes);
        if (segment == 0 && frame.predicted && in.number(1) > 0) {
            const std::size_t held = frameNumber - repeats,
                              step = types_.size() * (metadata_["data"]["lattice"]["kind"] == "d4" ? 2 : 1);
            need(held >= step && frames_[held - step].mask == frame.mask, "prediction");
            before = brick(held - step, number, level);
        }
        if (segment == 0 && frame.subsampled) {
            std::size_t count = 0;
            for (std::size_t s = 0; s < std::size_t(sublattices); ++s) {
                Size size = {fine[0], fine[1], (fine[2] + sublattices - 1 - int(s)) / sublattices};
                for (int l = 1; l < levels_; ++l) size = half(size);
                places({0, 0, 0}, size, [&](const Size& p) {
                    const int z = (p[2] << (levels_ - 1)) * sublattices + int(s);
                    count += flags[(std::size_t(z) * std::size_t(fine[1]) + std::size_t(p[1] << (levels_ - 1))) *
                                       std::size_t(fine[0]) +
                                   std::size_t(p[0] << (levels_ - 1))]
                                 ? 1
                                 : 0;
                });
            }
            subsamples = stream(in, count);
        }
        if (frame.numbers == 4 || (fitted && segment > 0 && !whole)) {
            if (segment == levels_ - 1) extras(in);
            later.push_back(in.take(std::size_t(in.end - in.at)));
            continue;
        }
        std::vector<Cell*> order;
        std::vector<Band> bands;
        for (Box& box : boxes) {
            if (centred && &box == &boxes[1]) { // undivided in the last segment, in no other
                if (segment < levels_ - 1) continue;
                bands.push_back({&box, {}, box.size, 0});
                places({0, 0, 0}, box.size, [&](const Size& p) { order.push_back(&box.at(p)); });
                continue;
            }
            Size part = box.size;
            for (int l = level; l < levels_ - 1 - segment; ++l) part = half(part);
            const Size low = half(part);
            for (int band = segment == 0 ? 0 : 1; band < (segment == 0 ? 1 : 8); ++band) {
                Size lo{}, hi = segment == 0 ? part : low;
                for (std::size_t a = 0; a < 3; ++a)
                    if ((band >> a & 1) != 0) lo[a] = low[a], hi[a] = part[a];
                if (hi[0] > lo[0] && hi[1] > lo[1] && hi[2] > lo[2]) bands.push_back({&box, lo, hi, band});
                places(lo, hi, [&](const Size& p) {
                    if (box.at(p)) order.push_back(&box.at(p));
                });
            }
        }
        if (segment == levels_ - 1) extras(in);
        if (whole) {
            need(in.at == in.end, "trailing bytes");
            continue;
        }
        if (in.at == in.end && bands.empty()) continue;
        need(in.at < in.end, "no mode");
        if ((*in.at == 5 || *in.at == 6 || (*in.at == 8 && knowsMixed_)) && segment == 0) {
            whole = true;
            const auto mode = in.number(1);
            const bool indexed = mode != 5;
            std::vector<std::uint32_t> colours;
            if (indexed)
                for (const auto step : stream(in, std::size_t(in.number(1)) + 1))
                    colours.push_back(colours.empty() ? unzigzag(step) : colours.back() + step);
            std::size_t present = 0;
            for (const bool flag : flags) present += flag ? 1 : 0;
            std::vector<std::uint32_t> symbols;
            if (mode == 8) {
                need(present == flags.size() && present <= 1 << 19 && colours.size() >= 2, "mixed");
                symbols = readMixed(in.take(std::size_t(in.end - in.at)), fine, bcc_, int(colours.size()));
            } else {
                symbols = stream(in, present);
            }
            need(in.at == in.end, "trailing bytes");
            const auto codeOf = [&](auto symbol) {
                need(!indexed || symbol < colours.size(), "index");
                return indexed ? colours[symbol] : unzigzag(symbol);
            };
            std::size_t next = 0;
            for (int s = 0; s < sublattices; ++s)
                boxes[std::size_t(s)] = makeBox({fine[0], fine[1], (fine[2] + sublattices - 1 - s) / sublattices});
            places({0, 0, 0}, fine, [&](const Size& p) {
                const std::size_t at =
                    (std::size_t(p[2]) * std::size_t(fine[1]) + std::size_t(p[1])) * std::size_t(fine[0]) +
                    std::size_t(p[0]);
                if (flags[at])
                    boxes[std::size_t(p[2] % sublattices)].at(p[0], p[1], p[2] / sublattices) = codeOf(symbols[next++]);
            });
        } else if (*in.at == 4) {
            (void)in.number(1);
            decodeBands(in.take(std::size_t(in.end - in.at)), bands, std::size_t(levels_ - 1 - segment), *model);
        } else if (order.empty()) {
            need(in.number(1) == 0, "mode");
        } else {
            const auto symbols = stream(in, order.size());
            for (std::size_t i = 0; i < order.size(); ++i) *order[i] = unzigzag(symbols[i]);
        }
        std::uint32_t code = 0;
        if (segment == 0 && !whole)
            for (Cell* cell : order) *cell = code += **cell;
        need(in.at == in.end, "trailing bytes");
    }

    if (frame.numbers == 4)
        corrections = readStepped({levels_, level, frame.wavelet, centred, flags.size(), checked(models_[frame.model])},
                                  later, boxes);

    if (fitted && !whole) {
        const bool isUnsigned = type == "uint8" || type == "uint16";
        const std::int64_t most = (std::int64_t(1) << std::min(frame.codeBits, 30)) - 1;
        readFitted({levels_, level, isUnsigned ? 0 : -most, most, *model}, later, boxes);
    }

    // 4.3
    const bool asFloat = frame.numbers == 2;
    int wavelet = frame.wavelet;
    if (asFloat) wavelet = wavelet == 0 || (wavelet >= 2 && wavelet <= 4) ? 0 : 1;
    const auto alongLines = [&](Box& box, const Size& part, std::size_t axis, auto&& change) {
        const Size low = half(part);
        Size lines = part;
        lines[axis] = 1;
        places({0, 0, 0}, lines, [&](const Size& start) {
            bool samples = asFloat;
            for (std::size_t earlier = 0; earlier < axis; ++earlier) samples = samples && start[earlier] < low[earlier];
            std::vector<Cell> line;
            Size p = start;
            for (p[axis] = 0; p[axis] < part[axis]; ++p[axis]) line.push_back(box.at(p));
            line = change(line, wavelet, samples);
            for (p[axis] = 0; p[axis] < part[axis]; ++p[axis]) box.at(p) = line[std::size_t(p[axis])];
        });
    };
    for (Box& box : boxes) {
        if (fitted && !whole) break;
        if (whole) { // 4.4: the coarse samples are made again
            Size part = box.size;
            for (int step = 0; step < level; ++step, part = half(part))
                for (const std::size_t axis : {0u, 1u, 2u}) alongLines(box, part, axis, redo);
            Box coarse = makeBox(part);
            places({0, 0, 0}, part, [&](const Size& p) { coarse.at(p) = box.at(p); });
            box = coarse;
            if (centred && level > 0 && &box == &boxes[1]) predictOdd(boxes[0], box, level);
            continue;
        }
        if (centred && &box == &boxes[1]) {
            predictOdd(boxes[0], box, level);
            continue;
        }
        std::vector<Size> parts{box.size};
        for (int step = 0; step < levels_ - 1 - level; ++step) parts.push_back(half(parts.back()));
        for (std::size_t step = parts.size() - 1; step-- > 0;) {
            for (const std::size_t axis : {2u, 1u, 0u}) alongLines(box, parts[step], axis, undo);
        }
    }

    // 3, in storage order
    Brick out;
    out.subsamples = subsamples;
    out.size = boxes[0].size;
    if (bcc_) out.size[2] += boxes[1].size[2];
    std::size_t nextAbsent = 0;
    places({0, 0, 0}, out.size, [&](const Size& p) {
        Cell cell = boxes[std::size_t(p[2] % sublattices)].at(p[0], p[1], p[2] / sublattices);
        for (Box& box : boxes)
            if (own.size() > 1 && box.at(p)) cell = box.at(p);
        const std::size_t at = out.values.size();
        out.present.push_back(cell.has_value());
        std::uint32_t code = cell.value_or(0);
        for (const auto& [sample, times] : corrections)
            if (sample == at) code += std::uint32_t(33 * times);
        double stored = double(asSigned(code));
        if (before) {
            const double stepped =
                type == "float32" ? double(std::bit_cast<float>(before->bits[at])) : double(asSigned(before->bits[at]));
            const double quotient = (stepped - frame.origin) / frame.step;
            if (std::abs(quotient) <= 536870912.0) code += std::uint32_t(std::int32_t(std::nearbyint(quotient)));
            stored = double(asSigned(code));
        }
        std::uint32_t bits = code;
        if (type == "float32") {
            float value = 0;
            if (frame.numbers == 1) value = float(stored / frame.step);
            if (frame.numbers == 2) value = floatOf(code);
            if (frame.numbers >= 3) value = float(frame.origin + frame.step * stored);
            if (level == 0)
                for (std::size_t e = 0; e < exactIndex.size(); ++e)
                    if (exactIndex[e] == at) value = std::bit_cast<float>(exactBits[e]);
            stored = double(value);
            bits = std::bit_cast<std::uint32_t>(value);
        }
        if (type != "float32" && frame.numbers == 4) {
            const double lowest = type == "int16" ? -32768.0 : type == "int32" ? -2147483648.0 : 0.0;
            const double most = type == "uint8"    ? 255.0
                                : type == "uint16" ? 65535.0
                                : type == "int16"  ? 32767.0
                                                   : 2147483647.0;
            stored = std::clamp(std::nearbyint(frame.origin + frame.step * stored), lowest, most);
            bits = std::uint32_t(std::int32_t(stored));
        }
        if (!cell && level == 0 && frame.keepsAbsent) bits = absentBits[nextAbsent++];
        out.values.push_back(cell ? frame.valueOffset + frame.valueScale * stored : 0);
        out.bits.push_back(bits);
    });
    return out;
}

} // namespace tessera::codec::plain
