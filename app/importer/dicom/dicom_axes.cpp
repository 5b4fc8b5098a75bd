#include "app/importer/dicom/dicom_axes.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string_view>

namespace tessera::importer {

namespace {

constexpr double kMillisecond = 1e-3;

/// Seconds of a date (YYYYMMDD, may be "") and a time (HHMMSS.FFFFFF), or of both in one word.
std::optional<double> secondsOf(std::string date, std::string time) {
    if (time.empty() && date.size() > 8) {
        time = date.substr(8);
        date.resize(8);
    }
    std::erase(time, ':'); // of early files
    std::erase(date, '.');
    time.resize(std::min(time.size(), time.find_first_of("+-& ")));
    const auto part = [](const std::string& text, std::size_t begin, std::size_t count) {
        int value = 0;
        for (std::size_t i = begin; i < begin + count && i < text.size(); ++i) {
            if (text[i] < '0' || text[i] > '9') return -1;
            value = value * 10 + text[i] - '0';
        }
        return value;
    };
    const int hours = part(time, 0, 2), minutes = part(time, 2, 2), seconds = part(time, 4, 2);
    if (time.size() < 2 || hours < 0 || minutes < 0 || seconds < 0) return std::nullopt;
    double out = hours * 3600.0 + minutes * 60.0 + seconds;
    double digit = 1;
    for (std::size_t i = 7; i < time.size() && time[6] == '.' && time[i] >= '0' && time[i] <= '9'; ++i)
        out += (time[i] - '0') * (digit /= 10);
    if (date.size() == 8 && part(date, 0, 8) > 0) {
        const std::chrono::year_month_day day{std::chrono::year(part(date, 0, 4)),
                                              std::chrono::month(unsigned(part(date, 4, 2))),
                                              std::chrono::day(unsigned(part(date, 6, 2)))};
        if (day.ok()) out += 86400.0 * double(std::chrono::sys_days(day).time_since_epoch().count());
    }
    return out;
}

/// The b-value that makers keep in elements of their own.
std::optional<double> privateBValue(const DicomItem& data) {
    const auto madeBy = [&](DicomTag creator, std::string_view words) { return data.text(creator).starts_with(words); };
    if (madeBy(0x00190010, "SIEMENS MR HEADER")) {
        const std::string digits = data.text(0x0019100c);
        if (!digits.empty() && digits.find_first_not_of("0123456789.") == std::string::npos) return std::stod(digits);
    }
    if (madeBy(0x20010010, "Philips Imaging DD 001"))
        if (const DicomElement* one = data.find(0x20011003); one != nullptr && one->type[0] == 'F')
            return data.number(0x20011003);
    if (madeBy(0x00430010, "GEMS_PARM_01"))
        if (const std::optional<double> stored = data.number(0x00431039)) return std::fmod(*stored, 1e5);
    return std::nullopt;
}

/// Dimensions of a multi-frame file that only its own index states.
void takeIndices(const DicomGroups& groups, DicomFrame& frame) {
    const std::vector<double> values = groups.numbers(0x00209111, 0x00209157);
    const std::vector<DicomItem>& dimensions = groups.root().items(0x00209222);
    if (values.size() != dimensions.size()) return;
    // Stack, place in it, position, or already known by their own elements.
    static constexpr DicomTag kKnown[] = {0x00209056, 0x00209057, 0x00200032, 0x00209128, 0x00209301,
                                          0x0062000b, 0x00200037, 0x0048021e, 0x0048021f, 0x00209113};
    int next = int(DicomAxis::Index0);
    for (std::size_t i = 0; i < values.size() && next <= int(DicomAxis::Index2); ++i) {
        const double pointer = dimensions[i].number(0x00209165, 0);
        if (std::ranges::any_of(kKnown, [&](DicomTag tag) { return double(tag) == pointer; })) continue;
        frame.axes[DicomAxis(next++)] = values[i];
    }
}

/// The times of a film: its steps, or its rate.
void takeFilm(const DicomItem& data, int index, DicomFrame& frame, const std::string& modality) {
    const std::vector<double> steps = data.numbers(0x00181065);
    const std::optional<double> step = data.number(0x00181063);
    const double rate = data.number(0x00180040, data.number(0x00082144, 0));
    static constexpr std::string_view kFilms[] = {"US", "XA", "RF", "ES", "XC", "GM", "IVUS", "OCT"};
    if (steps.size() > std::size_t(index)) {
        double sum = 0;
        for (int i = 0; i <= index; ++i) sum += steps[std::size_t(i)];
        frame.axes[DicomAxis::FrameTime] = sum - steps[0];
    } else if (step && *step > 0) {
        frame.axes[DicomAxis::FrameTime] = index * *step;
    } else if (rate > 0) {
        frame.axes[DicomAxis::FrameTime] = index / (rate * kMillisecond);
    } else if (std::ranges::find(kFilms, modality) != std::end(kFilms)) {
        frame.axes[DicomAxis::Slot] = index;
    }
}

} // namespace

DicomAxisWords wordsOf(DicomAxis axis) {
    static constexpr std::array<DicomAxisWords, 18> kWords = {{{"temporal position", ""},
                                                               {"trigger time", "ms"},
                                                               {"frame reference time", "ms"},
                                                               {"frame", ""},
                                                               {"frame time", "ms"},
                                                               {"b-value", "s/mm2"},
                                                               {"echo time", "ms"},
                                                               {"inversion time", "ms"},
                                                               {"flip angle", "degree"},
                                                               {"energy window", ""},
                                                               {"detector", ""},
                                                               {"view", ""},
                                                               {"index", ""},
                                                               {"second index", ""},
                                                               {"third index", ""},
                                                               {"acquisition time", "s"},
                                                               {"content time", "s"},
                                                               {"acquisition", ""}}};
    return kWords[std::size_t(axis)];
}

DicomGroups::DicomGroups(const DicomItem& root, std::size_t frame) : root_(&root) {
    shared_ = root.item(0x52009229);
    const std::vector<DicomItem>& each = root.items(0x52009230);
    if (frame < each.size()) own_ = &each[frame];
}

const DicomItem* DicomGroups::item(DicomTag sequence) const {
    for (const DicomItem* from : {own_, shared_, root_})
        if (from != nullptr)
            if (const DicomItem* found = from->item(sequence)) return found;
    return nullptr;
}

const DicomItem* DicomGroups::holder(DicomTag sequence, DicomTag tag) const {
    for (const DicomItem* from : {own_, shared_, root_}) {
        const DicomItem* inner = from != nullptr ? from->item(sequence) : nullptr;
        if (inner != nullptr && inner->find(tag) != nullptr) return inner;
    }
    return root_;
}

std::vector<double> DicomGroups::numbers(DicomTag sequence, DicomTag tag) const {
    return holder(sequence, tag)->numbers(tag);
}
std::optional<double> DicomGroups::number(DicomTag sequence, DicomTag tag) const {
    return holder(sequence, tag)->number(tag);
}
std::string DicomGroups::text(DicomTag sequence, DicomTag tag) const {
    return holder(sequence, tag)->text(tag);
}

std::string DicomGroups::kind() const {
    for (const DicomTag sequence :
         {0x00189226u, 0x00189329u, 0x00189751u, 0x00189504u, 0x00189807u}) // MR, CT, PET, XA, US
        if (const DicomItem* found = item(sequence))
            if (std::string words = found->text(0x00089007); !words.empty()) return words;
    return {};
}

void takeAxes(const DicomGroups& groups, bool several, int index, const DicomImage& image, DicomFrame& frame) {
    const DicomItem& root = groups.root();
    const auto take = [&](DicomAxis axis, std::optional<double> value) {
        if (value) frame.axes[axis] = *value;
    };
    take(DicomAxis::Temporal, root.number(0x00200100));
    take(DicomAxis::Temporal, groups.number(0x00209111, 0x00209128));
    take(DicomAxis::Trigger, root.number(0x00181060));
    take(DicomAxis::Trigger, groups.number(0x00189118, 0x00209153));
    take(DicomAxis::Reference, root.number(0x00541300));
    if (const std::optional<double> offset = groups.number(0x00209310, 0x0020930d))
        take(DicomAxis::Reference, *offset * 1000);
    take(DicomAxis::BValue, privateBValue(root));
    take(DicomAxis::BValue, groups.number(0x00189117, 0x00189087));
    take(DicomAxis::Echo, root.number(0x00180081));
    take(DicomAxis::Echo, groups.number(0x00189114, 0x00189082));
    take(DicomAxis::Inversion, root.number(0x00180082));
    take(DicomAxis::Flip, groups.number(0x00189112, 0x00181314));
    take(DicomAxis::Acquisition, root.number(0x00200012));
    std::optional<double> acquired = secondsOf(root.text(0x0008002a), "");
    if (!acquired) acquired = secondsOf(root.text(0x00080022), root.text(0x00080032));
    const std::string started = groups.text(0x00209111, 0x00189074), referred = groups.text(0x00209111, 0x00189151);
    if (const std::optional<double> own = secondsOf(started.empty() ? referred : started, "")) acquired = own;
    take(DicomAxis::Acquired, acquired);
    take(DicomAxis::Content, secondsOf(root.text(0x00080023), root.text(0x00080033)));
    takeIndices(groups, frame);
    if (!several) return;
    const auto listed = [&](DicomAxis axis, DicomTag tag) {
        const std::vector<double> list = root.numbers(tag);
        if (list.size() == std::size_t(image.form.frames)) frame.axes[axis] = list[std::size_t(index)];
    };
    listed(DicomAxis::Slot, 0x00540100);
    listed(DicomAxis::Slot, 0x00540070);
    listed(DicomAxis::Temporal, 0x00540030);
    listed(DicomAxis::Energy, 0x00540010);
    listed(DicomAxis::Detector, 0x00540020);
    listed(DicomAxis::View, 0x00540090);
    if (image.modality != "NM" && image.modality != "PT") takeFilm(root, index, frame, image.modality);
}

} // namespace tessera::importer
