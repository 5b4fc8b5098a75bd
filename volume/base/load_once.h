#pragma once

#include <functional>
#include <future>
#include <iterator>
#include <list>
#include <memory>
#include <mutex>
#include <tbb/task_arena.h>
#include <unordered_map>

namespace tessera::volume {

/// A cache with a byte budget: each value is loaded once however many threads request it at the same time; the least
/// recently used are evicted when the budget is exceeded (never the one just requested). A failure is thrown to all who
/// wait for the value, and not cached.
template <class Key, class Value, class Hash> class LoadOnce {
public:
    using Pointer = std::shared_ptr<const Value>;

    /// `load` is called without holding a lock, concurrently for different keys; `bytes` is the cost of a value.
    LoadOnce(std::size_t budget, std::function<Pointer(const Key&)> load,
             std::function<std::size_t(const Value&)> bytes)
        : budget_(budget), load_(std::move(load)), bytes_(std::move(bytes)) {}

    Pointer get(const Key& key) {
        std::promise<Pointer> promise;
        {
            std::unique_lock lock(mutex_);
            if (const auto found = entries_.find(key); found != entries_.end()) {
                recent_.splice(recent_.begin(), recent_, found->second.place);
                const std::shared_future<Pointer> future = found->second.value;
                lock.unlock();
                return future.get();
            }
            recent_.push_front(key);
            entries_[key] = {promise.get_future().share(), recent_.begin(), 0, false};
        }
        try {
            // Isolated: while this thread waits for parallel work of its own it must not pick up an outer task, which
            // could wait for this very value.
            Pointer value = tbb::this_task_arena::isolate([&] { return load_(key); });
            promise.set_value(value);
            settle(key, bytes_(*value));
            return value;
        } catch (...) {
            {
                const std::lock_guard lock(mutex_);
                const auto entry = entries_.find(key);
                recent_.erase(entry->second.place);
                entries_.erase(entry);
            }
            promise.set_exception(std::current_exception());
            throw;
        }
    }

    /// True when the value is here, loaded.
    bool has(const Key& key) const {
        const std::lock_guard lock(mutex_);
        const auto found = entries_.find(key);
        return found != entries_.end() && found->second.loaded;
    }

    /// Copies the values of another cache for the keys for which `keep` is true, in the same order of recent use.
    template <class Keep> void adopt(const LoadOnce& other, Keep&& keep) {
        const std::scoped_lock lock(mutex_, other.mutex_);
        for (const Key& key : other.recent_) {
            const Entry& entry = other.entries_.at(key);
            if (!entry.loaded || !keep(key) || entries_.contains(key)) continue;
            recent_.push_back(key);
            entries_[key] = {entry.value, std::prev(recent_.end()), entry.bytes, true};
            used_ += entry.bytes;
        }
        trim(nullptr);
    }

    std::size_t used() const {
        const std::lock_guard lock(mutex_);
        return used_;
    }

    void setBudget(std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        budget_ = bytes;
        trim(nullptr);
    }

private:
    struct Entry {
        std::shared_future<Pointer> value;
        typename std::list<Key>::iterator place;
        std::size_t bytes = 0;
        bool loaded = false;
    };

    void settle(const Key& key, std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        Entry& own = entries_.at(key);
        own.bytes = bytes;
        own.loaded = true;
        used_ += bytes;
        trim(&key);
    }

    /// Under the mutex.
    void trim(const Key* kept) {
        for (auto place = recent_.end(); used_ > budget_ && place != recent_.begin();) {
            --place;
            const auto entry = entries_.find(*place);
            if (!entry->second.loaded || (kept && entry->first == *kept)) continue;
            used_ -= entry->second.bytes;
            entries_.erase(entry);
            place = recent_.erase(place);
        }
    }

    std::size_t budget_, used_ = 0;
    std::function<Pointer(const Key&)> load_;
    std::function<std::size_t(const Value&)> bytes_;
    mutable std::mutex mutex_;
    std::list<Key> recent_; ///< most recent first
    std::unordered_map<Key, Entry, Hash> entries_;
};

} // namespace tessera::volume
