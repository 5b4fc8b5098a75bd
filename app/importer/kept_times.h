#pragma once

#include "app/importer/open_source.h"

#include <cstddef>
#include <list>
#include <map>
#include <utility>
#include <vector>
#include <vtkDataSet.h>

/// What earlier requests have read.
namespace tessera::importer {

/// The blocks of files at times, within a bound on memory: those that were asked for longest ago are dropped. Finding
/// one of many thousand costs no more than finding one of few.
class KeptTimes {
public:
    /// `mostKilobytes`: of all blocks; a time that has more is kept alone.
    explicit KeptTimes(std::size_t mostKilobytes) : mostKilobytes_(mostKilobytes) {}

    /// The blocks of a file at a time; null where they are not kept. Valid until the next change.
    const std::vector<Block>* find(std::size_t file, int time) {
        const auto known = places_.find({file, time});
        if (known == places_.end()) return nullptr;
        all_.splice(all_.begin(), all_, known->second);
        return &all_.front().blocks;
    }
    /// Keeps blocks that were not kept.
    const std::vector<Block>& add(std::size_t file, int time, std::vector<Block> blocks) {
        const std::size_t kilobytes = kilobytesOf(blocks);
        all_.push_front({{file, time}, std::move(blocks), kilobytes});
        places_[{file, time}] = all_.begin();
        kilobytes_ += kilobytes;
        while (all_.size() > 1 && kilobytes_ > mostKilobytes_) dropLast();
        return all_.front().blocks;
    }
    /// Drops all but those that were asked for last, so many.
    void keepLatest(std::size_t count) {
        while (all_.size() > count) dropLast();
    }

private:
    using Key = std::pair<std::size_t, int>; ///< file and time
    struct Kept {
        Key key;
        std::vector<Block> blocks;
        std::size_t kilobytes;
    };

    static std::size_t kilobytesOf(const std::vector<Block>& blocks) {
        constexpr std::size_t kObjects = 16; // what VTK needs beside the numbers
        std::size_t sum = 0;
        for (const Block& block : blocks) sum += kObjects + block.data->GetActualMemorySize();
        return sum;
    }
    void dropLast() {
        kilobytes_ -= all_.back().kilobytes;
        places_.erase(all_.back().key);
        all_.pop_back();
    }

    std::size_t mostKilobytes_, kilobytes_ = 0;
    std::list<Kept> all_; ///< most recent first
    std::map<Key, std::list<Kept>::iterator> places_;
};

} // namespace tessera::importer
