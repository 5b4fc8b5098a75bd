// Forms of raw files: the JSON sidecar, the text of --raw, NRRD headers, and lists of files.
#include "volume/base/error.h"
#include "volume/import/absent.h"
#include "volume/import/files/nrrd.h"
#include "volume/import/files/raw.h"
#include "volume/import/files/series.h"

#include <cstdint>
#include <cstdlib>
#include <string>

using namespace tessera;

namespace {

/// What was let through must be a form whose size can be computed.
void check(const volume::RawForm& form) {
    for (int axis = 0; axis < 3; ++axis)
        if (form.lattice.size[axis] < 1 || !(form.lattice.spacing[axis] > 0)) std::abort();
    if (form.components.empty() || form.bytes() < form.lattice.count()) std::abort();
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
    attempt([&] { check(volume::parseSidecar(text, "a.json")); });
    attempt([&] { check(volume::parseRawOption(text)); });
    attempt([&] {
        const volume::StoredImage image = volume::parseNrrd(text);
        if (image.samples() == 0 || !(image.bytes() > 0) || image.channels.empty()) std::abort();
        if (!image.times.empty() && image.times.size() != image.frames) std::abort();
    });
    attempt([&] { volume::parsePvd(text, "a.pvd"); });
    attempt([&] { volume::parseSeries(text, "a.series"); });
    attempt([&] { volume::parseAbsentRule(text); });
    return 0;
}
