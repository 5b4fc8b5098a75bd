#pragma once

#include "app/described/describe_json.h"

#include <random>

/// Random values for everything described, within ranges: for round-trip tests.
namespace tessera::app {

struct Randomise {
    std::mt19937& random;
    int depth = 0;

    double number(const FieldInfo& info) const {
        if (info.range) return std::uniform_real_distribution(info.range->lo, info.range->hi)(random);
        switch (random() % 6) {
        case 0:
            return 0;
        case 1:
            return -1e-30;
        case 2:
            return 1e30;
        default:
            return std::uniform_real_distribution(-1000.0, 1000.0)(random);
        }
    }
    std::string text() const {
        static const char* const words[] = {"", "O2", "|U|", "a/b~c", "line\nbreak \"quoted\"", "µm·s⁻¹", "U.x"};
        return words[random() % std::size(words)];
    }

    void operator()(Value value, const FieldInfo& info) const {
        switch (value.kind()) {
        case ValueKind::Struct:
            if (depth < 5) value.visitMembers(Randomise{random, depth + 1});
            break;
        case ValueKind::Text:
            value.text() = text();
            break;
        case ValueKind::List: {
            const std::size_t count = depth > 3 ? 0 : random() % 4;
            value.type->resize(value.at, 0);
            value.type->resize(value.at, count);
            for (std::size_t i = 0; i < count; ++i) Randomise{random, depth + 1}(value.element(i), info);
            break;
        }
        case ValueKind::Map:
            value.type->clear(value.at);
            for (std::size_t i = random() % 4; i-- > 0;)
                Randomise{random, depth + 1}(value.type->insert(value.at, text()), info);
            break;
        case ValueKind::Optional:
            value.type->clear(value.at);
            if ((random() & 1) == 0) break;
            value.type->emplace(value.at);
            (*this)(value.inside(), info);
            break;
        case ValueKind::Variant:
            value.type->hold(value.at, random() % value.type->names.size());
            (*this)(value.inside(), info);
            break;
        default:
            for (int i = 0; i < value.type->numbers; ++i) value.setNumber(numberFor(value, info), i);
        }
    }

    double numberFor(Value value, const FieldInfo& info) const {
        if (value.kind() == ValueKind::Flag) return (random() & 1) != 0 ? 1 : 0;
        if (value.kind() == ValueKind::Choice) return double(random() % info.names.size());
        if (value.kind() != ValueKind::Number || !value.type->whole) return number(info);
        return info.range ? double(std::uniform_int_distribution<long>(static_cast<long>(info.range->lo),
                                                                       static_cast<long>(info.range->hi))(random))
                          : double(static_cast<int>(random()));
    }
};

template <class T> T randomValue(std::mt19937& random) {
    T value{};
    Randomise{random}(valueOf(value), FieldInfo{"", ""});
    return value;
}

} // namespace tessera::app
