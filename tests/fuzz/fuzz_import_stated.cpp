// What the user states: tables over time, names of labels, parts, absent samples.
#include "volume/base/error.h"
#include "volume/field/labels.h"
#include "volume/import/absent.h"
#include "volume/import/find_parts.h"
#include "volume/import/over_time.h"

#include <cstdint>
#include <cstdlib>
#include <string>

using namespace tessera;

namespace {

volume::DatasetInfo smallInfo() {
    volume::DatasetInfo info;
    info.times = {0, 1, 2.5};
    info.parameters.resize(2);
    info.parameters[0].name = "T";
    info.parameters[1].name = "region";
    info.parameters[1].categorical = true;
    info.parameters[1].labels = {{0, "cathode"}, {1, "anode"}};
    return info;
}

template <class Parse> void attempt(Parse&& parse) {
    try {
        parse();
    } catch (const Error&) {
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    attempt([&] {
        const volume::TimeTable table = volume::parseTimeTable(text, "a.csv");
        for (std::size_t i = 1; i < table.times.size(); ++i)
            if (!(table.times[i] > table.times[i - 1])) std::abort();
        for (const volume::Quantity& column : table.columns)
            if (column.values.size() != table.times.size()) std::abort();
        volume::DatasetInfo info = smallInfo();
        volume::addTable(info, table);
        for (const volume::Quantity& quantity : info.quantities)
            if (quantity.values.size() != info.times.size()) std::abort();
    });
    attempt([&] {
        const volume::LabelRule rule = volume::parseLabelRule(text);
        volume::toText(rule);
        volume::DatasetInfo info = smallInfo();
        volume::applyLabels(info, {rule});
    });
    attempt([&] {
        volume::DatasetInfo info = smallInfo();
        volume::setParts(info, {volume::parsePartsRule(text)});
        volume::partsText(info.parameters[0]);
    });
    attempt([&] { volume::toText(volume::parseAbsentRule(text)); });
    return 0;
}
