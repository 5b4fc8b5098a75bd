#pragma once

#include <optional>
#include <utility>

namespace tessera::volume {

/// A value and the key that it was made for. The key is a plain struct whose operator== is defaulted, so that no member
/// of it can be left out of the comparison; what makes the value gets the key, so that it need not look at anything
/// else:
///
///     const Table& table = table_.get(TableKey{curve, size}, [](const TableKey& key) { return makeTable(key); });
template <class Key, class Value> class Cached {
public:
    /// The value for a key, made unless it is here. When `make` throws there is none.
    template <class Make> const Value& get(const Key& key, Make&& make) {
        if (!holds(key)) {
            key_.reset();
            value_ = std::forward<Make>(make)(key);
            key_ = key;
        }
        return value_;
    }
    bool holds(const Key& key) const { return key_ && *key_ == key; }
    /// The value made last; Value() before the first.
    const Value& value() const { return value_; }
    /// The next get() makes a value, whatever its key.
    void clear() { key_.reset(); }

private:
    std::optional<Key> key_;
    Value value_{};
};

} // namespace tessera::volume
