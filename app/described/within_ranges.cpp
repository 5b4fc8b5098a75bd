#include "app/described/within_ranges.h"

#include <algorithm>
#include <cmath>

namespace tessera::app::detail {

void keepWithinRanges(Value value, const FieldInfo& info) {
    switch (value.kind()) {
    case ValueKind::Flag:
    case ValueKind::Choice:
    case ValueKind::Text:
        return;
    case ValueKind::Struct:
        return value.visitMembers([](Value member, const FieldInfo& of) { keepWithinRanges(member, of); });
    case ValueKind::List:
        for (std::size_t i = 0; i < value.size(); ++i) keepWithinRanges(value.element(i), info);
        return;
    case ValueKind::Map:
        return value.type->visitElements(value.at,
                                         [&](const std::string&, Value element) { keepWithinRanges(element, info); });
    case ValueKind::Optional:
        if (value.inside().at) keepWithinRanges(value.inside(), info);
        return;
    case ValueKind::Variant:
        return keepWithinRanges(value.inside(), info);
    default:
        if (!info.range) return;
        for (int i = 0; i < value.type->numbers; ++i) {
            const double number = value.number(i);
            if (std::isnan(number))
                value.setNumber(info.range->lo, i);
            else if (!(number >= info.range->lo && number <= info.range->hi))
                value.setNumber(std::clamp(number, info.range->lo, info.range->hi), i);
        }
    }
}

} // namespace tessera::app::detail
