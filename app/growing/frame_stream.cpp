#include "app/growing/frame_stream.h"

#include "app/growing/held_signals.h"
#include "codec/archive/archive.h"
#include "volume/base/error.h"
#include "volume/base/number_text.h"
#include "volume/base/terminal.h"
#include "volume/import/files/raw.h"
#include "volume/system/part_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <poll.h>
#include <span>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace tessera::app {

namespace {

namespace fs = std::filesystem;

constexpr const char* kInput = "standard input";

/// A folder for frames as numbered files of one series, which the importer reads; removed in the end, or by the next
/// one where the process was killed.
class FrameFolder {
public:
    explicit FrameFolder(std::string series) : series_(std::move(series)) {
        const std::string common = (fs::temp_directory_path() / "tessera-frames").string();
        removeLeftParts(common);
        folder_ = partFileOf(common);
        std::error_code ignored;
        fs::remove_all(folder_, ignored); // of a former process with this number
        if (::mkdir(folder_.c_str(), S_IRWXU) != 0) throw MachineError(std::strerror(errno), folder_.string());
        lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        ::flock(lock_, LOCK_EX | LOCK_NB); // says to leftParts(), also in other containers, that it is in use
    }
    ~FrameFolder() {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
        ::close(lock_);
    }
    FrameFolder(const FrameFolder&) = delete;
    FrameFolder& operator=(const FrameFolder&) = delete;

    fs::path file(std::size_t number) const { return folder_ / (series_ + "_" + std::to_string(number) + ".raw"); }

private:
    fs::path folder_;
    std::string series_;
    int lock_ = -1;
};

/// Standard input, read while SIGINT and SIGTERM are held.
class Input {
public:
    /// Fills `out` and returns the bytes that came before the input ended or a signal arrived.
    std::size_t read(std::span<char> out) {
        std::size_t done = 0;
        while (done < out.size() && !stopped_) {
            constexpr int kPause = 100; // milliseconds
            pollfd waited{STDIN_FILENO, POLLIN, 0};
            if (signals_.arriveWithin(0)) stopped_ = true;
            if (stopped_ || ::poll(&waited, 1, kPause) == 0) continue;
            const ssize_t count = ::read(STDIN_FILENO, out.data() + done, out.size() - done);
            if (count < 0 && errno != EINTR) throw MachineError(std::strerror(errno), kInput);
            if (count == 0) break;
            done += std::size_t(std::max<ssize_t>(count, 0));
        }
        return done;
    }
    bool stopped() const { return stopped_; }

private:
    HeldSignals signals_;
    bool stopped_ = false;
};

volume::RawForm formOfFrames(const GrowingRequest& request) {
    if (request.import.raw.empty())
        throw Error("needs the layout of a frame: --raw dims=XxYxZ,type=f32,components=N, or a sidecar (.json)",
                    kInput);
    volume::RawForm form = volume::statedForm(request.import.raw);
    if (form.frames() > 1 || form.skip > 0)
        throw Error("a frame on standard input is one time, from its first byte on", request.import.raw,
                    "--raw times, skip");
    return form;
}

/// The series has the name of the archive to continue, else that of the file.
std::string seriesName(const StreamRequest& request) {
    std::string name;
    if (request.append) name = codec::Archive(request.archive.output).info().name;
    const bool fits = !name.empty() && name.find('/') == std::string::npos;
    return fits ? name : fs::path(request.archive.output).stem().string();
}

double timeFrom(std::array<char, sizeof(double)> bytes, bool bigEndian) {
    if (bigEndian) std::ranges::reverse(bytes);
    const double time = std::bit_cast<double>(bytes);
    if (!std::isfinite(time)) throw Error("the time of a frame is not a finite number", kInput);
    return time;
}

/// One run of `tessera pack -`.
class Streaming {
public:
    explicit Streaming(const StreamRequest& request)
        : request_(request), form_(formOfFrames(request.archive)), output_(withArchive(request), !request.append),
          folder_(seriesName(request)) {
        if (!request.append) return;
        const volume::DatasetInfo info = codec::Archive(request.archive.output).info();
        known_ = info.times.size();
        last_ = before_ = info.times.back();
    }
    void run();

private:
    static GrowingRequest withArchive(const StreamRequest& request);
    std::optional<StatedFrame> next();
    double countedTime() const;
    bool readInto(const fs::path& file);
    [[noreturn]] void endsEarly(std::size_t bytes, std::size_t of) const;

    const StreamRequest& request_;
    volume::RawForm form_;
    GrowingOutput output_;
    FrameFolder folder_;
    Input input_;
    std::size_t known_ = 0, read_ = 0; ///< times in the archive before, frames read
    std::optional<double> last_;       ///< time of the archive
    std::optional<double> before_;     ///< its last time before this run
    std::optional<fs::path> first_;    ///< file of the frame that decided for the others
};

/// An archive to continue keeps its options.
GrowingRequest Streaming::withArchive(const StreamRequest& request) {
    GrowingRequest out = request.archive;
    if (!request.append) return out;
    const double memoryMb = out.options.memoryMb;
    out.options = codec::Archive(out.output).metadata().options;
    out.options.memoryMb = memoryMb;
    return out;
}

void Streaming::endsEarly(std::size_t bytes, std::size_t of) const {
    throw Error("ends within frame " + std::to_string(read_) + ", after " + std::to_string(bytes) + " of " +
                    std::to_string(of) + " bytes; the frames before are in the archive",
                kInput);
}

/// Copies the samples of a frame; false if the input has ended before the first of them, or a signal arrived.
bool Streaming::readInto(const fs::path& file) {
    const std::size_t size = form_.bytes();
    std::vector<char> bytes(std::min<std::size_t>(size, std::size_t(4) << 20));
    std::ofstream out(file, std::ios::binary);
    for (std::size_t done = 0; done < size;) {
        const std::size_t wanted = std::min(bytes.size(), size - done), count = input_.read({bytes.data(), wanted});
        done += count;
        if (count < wanted && input_.stopped()) return false;
        if (count < wanted && done == 0 && !request_.timesGiven) return false;
        if (count < wanted) endsEarly(done, size);
        out.write(bytes.data(), static_cast<std::streamsize>(count));
    }
    out.close();
    if (!out) throw MachineError("cannot be written", file.string());
    return true;
}

/// The time of the next frame where it does not state one: it goes on after the last one by a step. Times that are
/// multiples of the step stay so, without adding up errors.
double Streaming::countedTime() const {
    const double step = request_.timeStep;
    if (!before_) return double(read_) * step;
    const double steps = std::round(*before_ / step);
    return steps * step == *before_ ? (steps + 1 + double(read_)) * step : *before_ + double(read_ + 1) * step;
}

/// The next frame that the archive lacks, in its file; none if the input has ended.
std::optional<StatedFrame> Streaming::next() {
    for (;; ++read_) {
        StatedFrame frame{read_, countedTime()};
        if (request_.timesGiven) {
            std::array<char, sizeof(double)> bytes{};
            const std::size_t count = input_.read(bytes);
            if (input_.stopped() || count == 0) return std::nullopt;
            if (count < bytes.size()) endsEarly(count, bytes.size() + form_.bytes());
            frame.time = timeFrom(bytes, form_.bigEndian);
        }
        const fs::path file = folder_.file(known_ + read_);
        if (!readInto(file)) return std::nullopt;
        if (!request_.timesGiven || !last_ || frame.time > *last_) return frame;
        if (!request_.append || output_.series())
            throw Error("time " + exactText(frame.time) + " of frame " + std::to_string(read_) +
                            " is not after the last one, " + exactText(*last_),
                        kInput);
        warn("tessera: time %.10g of frame %zu is in the archive already\n", frame.time, read_);
        fs::remove(file);
    }
}

void Streaming::run() {
    while (const std::optional<StatedFrame> frame = next()) {
        const fs::path file = folder_.file(known_ + read_);
        output_.append(file.string(), frame);
        last_ = frame->time;
        if (!first_)
            first_ = file; // each later frame is read beside it
        else
            fs::remove(file);
        ++read_;
    }
    if (read_ == 0 && !input_.stopped()) throw Error("no frame arrived", kInput);
}

} // namespace

void packStream(const StreamRequest& request) {
    if (::isatty(STDIN_FILENO) != 0)
        throw Error("is a terminal: frames come from a pipe or a file, such as ./solver | tessera pack -", kInput);
    if (!request.timesGiven && !(request.timeStep > 0)) throw Error("must be greater than 0", {}, "--time-step");
    Streaming(request).run();
}

} // namespace tessera::app
