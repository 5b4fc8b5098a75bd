#include "app/growing/growing_output.h"

#include "app/user_files/import_memory.h"
#include "codec/container/json_text.h"
#include "codec/pack/pack.h"
#include "volume/base/byte_text.h"
#include "volume/base/error.h"
#include "volume/base/terminal.h"
#include "volume/import/parts_rules.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

namespace tessera::app {

namespace {

void requireFrameByFrame(const codec::PackOptions& options) {
    if (options.lattice == codec::StoredLattice::D4)
        throw Error("each time of D4* is computed from several of the series: one that grows is stored as cc or bcc",
                    {}, "--lattice d4");
    if (options.sizeMb > 0) throw Error("the size of a series that grows is not known", {}, "--target-size");
    if (options.discard > 0) throw Error("the importance at later times is not known", {}, "--discard");
}

/// Says what the first file of a series decides for all others.
void sayDecided(const volume::GrowingSeries& series, const volume::ImportOptions& stated, const std::string& first) {
    const auto say = [&](const std::string& text) {
        warn("tessera: %s: %s (taken for all later times)\n", first.c_str(), text.c_str());
    };
    for (const std::string& rule : series.options.absent)
        if (std::ranges::find(stated.absent, rule) == stated.absent.end()) say("absent: " + rule);
    for (const volume::Parameter& parameter : series.info.parameters)
        if (parameter.parts.count() > 1) say(parameter.name + ": " + volume::partsText(parameter));
}

std::string frameText(const StatedFrame& stated) {
    return "frame " + std::to_string(stated.number);
}

} // namespace

GrowingOutput::GrowingOutput(GrowingRequest request, bool replaces)
    : request_(std::move(request)), replaces_(replaces) {
    requireFrameByFrame(request_.options);
}

bool GrowingOutput::continues() const {
    std::error_code ignored;
    return !replaces_ && std::filesystem::exists(request_.output, ignored);
}

volume::GrowingSeries GrowingOutput::openFirst(const std::string& path) const {
    volume::GrowingSeries series = volume::growingSeries(path, request_.import);
    const volume::ImportOptions recalled = withMemory(request_.import, loadImportMemory(), series.info);
    sayRemembered(request_.import, recalled);
    if (recalled != request_.import) series = volume::growingSeries(path, recalled);
    rememberStated(request_.import, series.info.name);
    return series;
}

void GrowingOutput::requireSameSeries(const codec::Archive& archive, const volume::GrowingSeries& series) const {
    const volume::DatasetInfo& info = archive.info();
    if (info.name != series.info.name)
        throw Error("holds the series " + info.name + ", the files are of " + series.info.name, request_.output);
    const bool labels = std::ranges::any_of(info.parameters, &volume::Parameter::categorical);
    const bool stated = !request_.import.autoAbsent && !request_.import.parts.empty();
    if (labels && !stated && info.times.front() != series.info.times.front())
        throw Error("the file of its first time is gone, where absent samples and parts were found: state them by "
                    "--no-auto-absent, --absent and --parts",
                    request_.output);
}

bool GrowingOutput::begin(const std::string& path) {
    try {
        series_ = openFirst(path);
    } catch (const Error&) {
        return false;
    }
    if (continues()) requireSameSeries(codec::Archive(request_.output), *series_);
    return true;
}

void GrowingOutput::append(const std::string& path, const std::optional<StatedFrame>& stated) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begun = Clock::now();
    volume::GrowingSeries series = series_ ? *series_ : openFirst(path);
    volume::Dataset data = volume::openOfSeries(series, path);
    if (stated) data.info.times = {stated->time};
    std::size_t before = 0;
    if (continues()) {
        const codec::Archive archive(request_.output);
        if (!series_) requireSameSeries(archive, series);
        before = archive.info().times.size();
        data = volume::timesAfter(std::move(data), archive.info().times.back(), stated ? frameText(*stated) : path);
    } else if (series_) {
        throw MachineError("was removed while it grew", request_.output);
    }
    const std::vector<double> times = data.info.times;
    const codec::PackSummary summary =
        before > 0 ? codec::append(data, request_.output, request_.options.memoryMb)
                   : codec::pack(data, request_.options, request_.output, {}, {.ofSeries = true});
    replaces_ = false;
    if (before == 0) sayDecided(series, request_.import, stated ? frameText(*stated) : path);
    if (!series_)
        for (const std::string& note : summary.notes) warn("tessera: %s\n", note.c_str());
    series_ = std::move(series);
    const double seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    for (std::size_t t = 0; t < times.size(); ++t) {
        const std::size_t count = before + t + 1;
        if (request_.json) {
            nlohmann::json line{{"time", times[t]},
                                {"times", count},
                                {"archiveBytes", summary.archiveBytes},
                                {"addedBytes", summary.addedBytes},
                                {"seconds", seconds}};
            if (stated)
                line["frame"] = stated->number;
            else
                line["file"] = path;
            sayJson(jsonText(line));
        } else {
            const std::string of = stated ? frameText(*stated) : std::filesystem::path(path).filename().string();
            say("%s: time %.10g of %s appended (%s, %s, %.2f s)\n", request_.output.c_str(), times[t], of.c_str(),
                timesCounted(count).c_str(), textOfBytes(double(summary.archiveBytes)).c_str(), seconds);
        }
    }
    std::fflush(stdout);
}

void sayRemembered(const volume::ImportOptions& stated, const volume::ImportOptions& used) {
    for (const std::string& rule : used.absent)
        if (std::ranges::find(stated.absent, rule) == stated.absent.end())
            warn("tessera: remembered: --absent %s\n", rule.c_str());
    for (const auto& [from, to] : used.rename)
        if (!stated.rename.contains(from)) warn("tessera: remembered: --rename %s=%s\n", from.c_str(), to.c_str());
}

std::string timesCounted(std::size_t times) {
    return std::to_string(times) + (times == 1 ? " time" : " times");
}

} // namespace tessera::app
