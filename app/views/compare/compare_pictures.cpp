#include "app/views/compare/compare_pictures.h"

#include "app/data/open.h"
#include "app/edits/compare_files.h"
#include "app/pane/inner_view.h"
#include "codec/archive/archive.h"
#include "codec/container/json_text.h"
#include "codec/remote/address.h"
#include "vis/transfer/transfer_function.h"
#include "volume/base/error.h"
#include "volume/bricks/source_at_time.h"
#include "volume/derived/derived.h"
#include "volume/sources/centred_source.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace tessera::app {

namespace {

/// Bytes of the archive that pictures are drawn from; 0 where it is none.
double storedBytes(const std::shared_ptr<const volume::BrickSource>& pictures) {
    if (!pictures) return 0;
    const auto shown = volume::centredFrom(*pictures);
    const auto below = volume::underived(shown ? shown : pictures);
    const auto* archive = dynamic_cast<const codec::Archive*>(below.get());
    return archive ? double(archive->fileBytes()) : 0;
}

/// Files named without a folder are in the folder of the session's data.
DataRef located(DataRef data, const DataRef& session) {
    std::string folder;
    if (!session.files.empty()) folder = std::filesystem::path(session.files[0].absolutePath).parent_path().string();
    if (!data.files.empty()) {
        ResolvedData found = resolveData(data, folder);
        if (!found.missing.empty()) throw Error("data file not found", found.missing.front().wanted.path);
        data = found.data;
    }
    return data;
}

/// Why a variant cannot have these data, "" if it can: only built-in models have a choice of size, and archives keep
/// the options they were packed with; those on another lattice than a regular grid are drawn on that alone.
std::string whyNot(const DataRef& wanted, const ViewContext& context) {
    const DataRef& session = context.session.data;
    if (wanted.files.empty() || wanted.files != session.files) return {};
    if (wanted.settings != session.settings) return "only built-in models can have another size";
    if (wanted.files.size() != 1 || !codec::namesArchive(wanted.files[0].absolutePath)) return {};
    if (wanted.lattice != session.lattice && !canChooseLattice(session, *context.numbers, context.origin))
        return "the archive holds no regular grid, so it is drawn on its own lattice alone; open the data that it was "
               "packed from";
    if (wanted.packed != session.packed)
        return "an archive cannot be packed again here; open the data that it was packed from";
    return {};
}

/// Equal sessions but for the panes, which no variant shows.
bool sameScene(const Session& a, const Session& b) {
    return a.camera == b.camera && a.time == b.time && a.cursor == b.cursor && a.layers == b.layers &&
           a.transfer == b.transfer && a.selection == b.selection && a.render == b.render && a.lighting == b.lighting &&
           a.clips == b.clips && a.tone == b.tone && a.depthMask == b.depthMask && a.lenses == b.lenses &&
           a.paper == b.paper && a.stretch == b.stretch && a.data == b.data && a.appearance == b.appearance;
}

} // namespace

std::shared_ptr<CompareData> ComparePictures::dataFor(ViewContext& context, const std::string& pane,
                                                      const DataRef& data) {
    const auto known = std::ranges::find_if(data_, [&](const auto& one) { return one->data == data; });
    auto found = known != data_.end() ? *known : data_.emplace_back(std::make_shared<CompareData>());
    found->data = data;
    if (found->source || !found->failure.empty()) return found;
    const auto opened = found->opening.get(
        context, std::shared_ptr<const void>(),
        {.key = pane + ":data" + jsonText(toJson(data)), .title = "Data to compare", .duringEdits = true}, data,
        [session = context.session.data](const auto&, const DataRef& asked, int, const Progress& progress) {
            CompareData::Opened out;
            out.sources =
                attempt(out.failure, [&] { return openSources(located(asked, session), out.messages, progress); });
            return out;
        },
        std::equal_to<>());
    found->failure = found->opening.failure();
    if (!opened) return found;
    found->source = opened->sources.pictures;
    // The variant is what an archive holds, not what it was packed from.
    found->numbers = opened->sources.packed ? opened->sources.packed
                     : data.packed          ? opened->sources.pictures
                                            : opened->sources.numbers;
    if (!data.packed) found->origin = opened->sources.origin;
    found->packedBytes = opened->sources.origin.packedBytes;
    found->failure = opened->failure;
    found->messages = opened->messages;
    return found;
}

/// Finds the data of a cell, `alone`: no more than its scene draws; false while they are opened, or where that failed.
bool ComparePictures::openCell(ViewContext& context, const std::string& pane, std::size_t index, bool alone) {
    CompareCell& cell = *cells_[index];
    if (!cell.failure.empty()) return false;
    if (!(cell.session.data == context.session.data)) {
        cell.failure = whyNot(cell.session.data, context);
        if (!cell.failure.empty()) return false;
        const auto data =
            dataFor(context, pane, alone ? drawnData(cell.session, context.source->info()) : cell.session.data);
        if (data != cell.data) cell.dropPicture();
        cell.data = data;
        if (!data->failure.empty()) {
            cell.failure = data->failure;
            return false;
        }
        if (!data->source) {
            context.answers.awaiting = true;
            return false;
        }
        if (!data->renderer) {
            data->renderer = context.renderer.another();
            data->renderer->setSource(data->source);
        }
    } else if (cell.data) {
        cell.data.reset();
        cell.dropPicture();
    }
    return true;
}

void ComparePictures::drawCell(ViewContext& context, const std::string& pane, std::size_t index, glm::ivec2 size,
                               bool moving) {
    CompareCell& cell = *cells_[index];
    cell.drawn = false;
    if (!openCell(context, pane, index, true)) return;
    ViewContext own = innerContext(context, cell.session, cell.data ? cell.data->source : context.source,
                                   cell.data ? *cell.data->renderer : context.renderer, context.caches);
    own.renderers = std::max(context.renderers, 1 + renderers());
    if (!cell.target) cell.target = own.renderer.makeTarget();
    vis::FrameRequest request;
    request.size = size;
    request.moving = moving && !context.headless;
    request.wait = context.headless;
    const vis::Scene scene = cell.shapes.get(own, pane + "/" + std::to_string(index), request.moving);
    const bool first = !cell.shows || request.moving || !(scene == cell.sceneShown);
    const double share = double(scene.render.limits.frameTime) / double(std::max<std::size_t>(cells_.size(), 1));
    request.budgetMs = first ? share : double(scene.render.limits.frameTime);
    if (!first && !request.wait && cell.sizeShown == size && refined_ != index && !cell.status.complete) {
        cell.drawn = context.answers.busy = true; // shown as it is until its turn
        return;
    }
    cell.sceneShown = scene;
    cell.sizeShown = size;
    cell.status = own.renderer.render(*cell.target, scene, request);
    if (cell.data) {
        std::vector<std::string>& said = cell.data->messages;
        for (std::string& text : own.renderer.takeMessages()) said.push_back(std::move(text));
        const std::string name = variantName(context.session, cell.variant);
        for (const std::string& text : std::exchange(said, {})) context.answers.messages.push_back(name + ": " + text);
    }
    cell.shows = cell.status.complete || cell.status.milliseconds > 0;
    cell.drawn = true;
    own.answers.follow(cell.status);
    context.answers.join(own.answers);
    if (own.answers.unfinished() || request.moving) return;
    if (cell.image && cell.image->size == size && cell.imageSource == own.source && cell.imageOf == scene) return;
    auto image = std::make_shared<vis::Image>();
    image->rgba = own.renderer.readPixels(*cell.target, image->size);
    cell.image = image;
    cell.imageOf = scene;
    cell.imageSource = own.source;
}

void ComparePictures::measure(ViewContext& context, const std::string& pane, std::size_t index, std::size_t reference) {
    CompareCell& cell = *cells_[index];
    const CompareCell& against = *cells_[reference];
    if (index == reference || !cell.finished() || !against.finished()) return;
    if (cell.image->size != against.image->size) return;
    cell.measured = cell.measuring.answer(
        context, std::shared_ptr<const void>(),
        {.key = pane + ":measure" + std::to_string(index), .title = "Error of a variant", .quiet = true},
        {cell.image, against.image},
        [](const auto&, const PicturePair& pair, int, const Progress&) {
            return PictureDifference{vis::difference(*pair.image, *pair.reference),
                                     vis::differenceMap(*pair.image, *pair.reference)};
        },
        std::equal_to<>());
}

namespace {

/// What the values of two variants are read from: their numbers, or where these are of the same data, their pictures,
/// which may lie on two lattices.
std::pair<std::shared_ptr<const volume::BrickSource>, std::shared_ptr<const volume::BrickSource>>
comparedSources(const ViewContext& context, const CompareCell& cell, const CompareCell& against) {
    DataRef own = cell.session.data;
    own.lattice = against.session.data.lattice;
    if (own == against.session.data) return {cell.source(context), against.source(context)};
    return {cell.numbers(context), against.numbers(context)};
}

} // namespace

void ComparePictures::measureSamples(ViewContext& context, const std::string& pane, std::size_t index,
                                     std::size_t reference) {
    CompareCell& cell = *cells_[index];
    const CompareCell& against = *cells_[reference];
    const auto [source, wanted] = comparedSources(context, cell, against);
    if (index == reference || !cell.failure.empty() || !source || !wanted) return;
    const CompareQuery query = compareQuery({cell.session, source}, {against.session, wanted});
    if (source == wanted && query.channel == query.referenceChannel && query.time == query.referenceTime) {
        cell.samplesOf = query;
        cell.samples.reset();
        return;
    }
    const auto found = cell.counting.answer(
        context, std::shared_ptr<const void>(),
        {.key = pane + ":samples" + std::to_string(index),
         .title = "Samples of a variant",
         .quiet = true,
         .duringEdits = true},
        query,
        [](const auto&, const CompareQuery& of, int,
           const Progress& progress) -> std::optional<volume::SourceDifference> {
            const volume::DatasetInfo &ownInfo = of.own->info(), &wantedInfo = of.reference->info();
            const auto a = ownInfo.findChannel(of.channel), b = wantedInfo.findChannel(of.referenceChannel);
            if (!a || !b) return std::nullopt;
            if (ownInfo.channel(*a).unit != wantedInfo.channel(*b).unit) return std::nullopt;
            try {
                const auto one = volume::sourceAt(of.own, volume::timesAround(ownInfo.times, of.time)),
                           other =
                               volume::sourceAt(of.reference, volume::timesAround(wantedInfo.times, of.referenceTime));
                return volume::sourceDifference({*one.source, *a, one.time}, {*other.source, *b, other.time}, progress);
            } catch (const Error&) {
                return std::nullopt; // damaged data: the picture says so
            }
        },
        [](const CompareQuery& a, const CompareQuery& b) { return a.sameData(b); });
    cell.samplesOf = found ? found->query : CompareQuery{};
    cell.samples = found ? found->result : std::nullopt;
}

void ComparePictures::prepare(const ViewContext& context, const std::vector<CompareVariant>& variants) {
    cells_.resize(variants.size());
    refined_ %= std::max<std::size_t>(cells_.size(), 1);
    for (std::size_t i = 0; i < variants.size(); ++i) {
        if (!cells_[i]) cells_[i] = std::make_shared<CompareCell>();
        CompareCell& cell = *cells_[i];
        if (!(cell.variant == variants[i])) cell.forgetNumbers();
        if (!(cell.variant == variants[i]) || !sameScene(cell.of, context.session)) {
            cell.variant = variants[i];
            cell.of = context.session;
            cell.failure.clear();
            try {
                Session bare = context.session;
                bare.views.clear();
                bare.dock = {};
                cell.session = variantSession(bare, cell.variant);
            } catch (const Error& error) {
                cell.failure = error.what();
            }
        }
    }
}

/// Drops data that no cell shows. Data that could not be opened are not tried again while the variant is unchanged.
void ComparePictures::dropUnused() {
    std::erase_if(data_, [&](const auto& data) {
        return std::ranges::none_of(
            cells_, [&](const auto& cell) { return cell->data == data && !(cell->session.data == cell->of.data); });
    });
}

void ComparePictures::open(ViewContext& context, const std::string& pane, std::size_t reference) {
    for (std::size_t i = 0; i < cells_.size(); ++i) openCell(context, pane, i, false);
    dropUnused();
    for (std::size_t i = 0; i < cells_.size(); ++i) measureSamples(context, pane, i, reference);
}

void ComparePictures::draw(ViewContext& context, const std::string& pane, std::size_t reference, glm::ivec2 size,
                           bool moving) {
    for (std::size_t i = 0; i < cells_.size(); ++i) drawCell(context, pane, i, size, moving);
    dropUnused();
    // Refine one picture at a time with the whole time of the frame: sharing it would repeat each picture's setup in
    // every frame.
    for (std::size_t i = 0; i < cells_.size() && cells_[refined_ % cells_.size()]->final(); ++i)
        refined_ = (refined_ + 1) % cells_.size();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        measure(context, pane, i, reference);
        measureSamples(context, pane, i, reference);
    }
}

int ComparePictures::renderers() const {
    return int(std::count_if(data_.begin(), data_.end(), [](const auto& data) { return data->renderer != nullptr; }) +
               std::count_if(cells_.begin(), cells_.end(),
                             [](const auto& cell) { return cell && cell->values.hasRenderer(); }));
}

double ComparePictures::differenceTop(double top) const {
    if (top <= 0)
        for (const auto& cell : cells_)
            if (cell->isMeasured()) top = std::max(top, cell->measured->result.of.maximum);
    return top > 0 ? top : 1;
}

void ComparePictures::showDifferences(vis::TexturesIn where, double top, std::size_t reference) {
    top = differenceTop(top);
    static const vis::TransferFunction scale = [] {
        vis::TransferFunction made;
        made.colormap = "inferno";
        return made;
    }();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        CompareCell& cell = *cells_[i];
        if (i == reference || !cell.isMeasured()) continue;
        if (cell.shownOf == cell.measured && cell.shownTop == top) continue;
        const std::vector<std::uint8_t>& map = cell.measured->result.map;
        std::vector<std::uint8_t> rgba;
        rgba.reserve(map.size() * 4);
        std::array<std::array<std::uint8_t, 3>, 256> colors;
        for (std::size_t value = 0; value < 256; ++value) {
            const glm::dvec4 color = vis::evaluate(scale, {0, 1}, std::min(1.0, double(value) / top));
            for (int c = 0; c < 3; ++c) colors[value][std::size_t(c)] = std::uint8_t(color[c] * 255 + 0.5);
        }
        for (const std::uint8_t value : map) {
            rgba.insert(rgba.end(), colors[value].begin(), colors[value].end());
            rgba.push_back(255);
        }
        cell.differencePicture.upload(where, cell.image->size, rgba);
        cell.shownOf = cell.measured;
        cell.shownTop = top;
    }
}

namespace {

/// Whether a picture shows how two data sets differ: it has no error beside one that shows their values.
bool showsDifference(const ViewContext& context, const CompareCell& cell) {
    const auto& source = cell.source(context);
    if (!source || cell.session.layers.empty()) return false;
    return isDifference(cell.session.data, source->info(), vis::shownChannel(cell.session.layers.front().technique));
}

} // namespace

std::vector<CompareRow> ComparePictures::rows(const ViewContext& context, std::size_t reference) const {
    std::vector<CompareRow> out;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const CompareCell& cell = *cells_[i];
        CompareRow row;
        row.name = variantName(context.session, cell.variant);
        row.changes = changesText(context.session, cell.variant);
        row.failure = cell.failure;
        row.reference = i == reference;
        row.milliseconds = cell.status.milliseconds;
        row.samples = double(cell.status.samples);
        row.bytes = double(cell.status.bytes);
        const double packed = cell.data ? cell.data->packedBytes : context.origin.packedBytes;
        row.storedBytes = packed > 0 ? packed : storedBytes(cell.source(context));
        const bool known = cell.isMeasured() && reference < cells_.size() &&
                           cell.measured->query.reference == cells_[reference]->image;
        const bool comparable = i != reference && reference < cells_.size() &&
                                showsDifference(context, cell) == showsDifference(context, *cells_[reference]);
        row.measured = known && comparable && cell.failure.empty();
        if (row.measured) {
            const vis::ImageDifference& of = cell.measured->result.of;
            row.maximum = of.maximum;
            row.rmse = of.rmse;
            row.psnr = of.psnr;
            row.ssim = of.ssim;
        }
        if (comparable) {
            const auto [own, wanted] = comparedSources(context, cell, *cells_[reference]);
            if (cell.samplesOf.own == own && cell.samplesOf.reference == wanted && wanted) row.data = cell.samples;
        }
        out.push_back(row);
    }
    return out;
}

double ComparePictures::findValues(ViewContext& context, const std::string& pane, std::size_t reference) {
    const CompareCell& against = *cells_[reference];
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        CompareCell& cell = *cells_[i];
        const auto [source, wanted] = comparedSources(context, cell, against);
        if (i == reference || !cell.failure.empty() || !against.failure.empty() || !source || !wanted) continue;
        cell.values.find(context, pane + ":values" + std::to_string(i), {cell.session, source},
                         {against.session, wanted});
    }
    return largestValue(reference);
}

double ComparePictures::largestValue(std::size_t reference) const {
    double top = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i)
        if (i != reference && cells_[i]->failure.empty()) top = std::max(top, cells_[i]->values.largest());
    return top > 0 ? top : 1;
}

} // namespace tessera::app
