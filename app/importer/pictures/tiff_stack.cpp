#include "app/importer/pictures/tiff_stack.h"

#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <stdexcept>

namespace tessera::importer {

bool arrangePlanes(TiffStack& stack, const std::vector<TiffPlane>& planes, const std::string& order) {
    const std::size_t count = stack.slices * stack.channels * stack.times;
    if (count != planes.size()) return false;
    stack.planes.assign(count, {});
    std::size_t at[3] = {}; // z, c, t
    const auto axisOf = [](char name) { return name == 'Z' ? 0u : name == 'C' ? 1u : 2u; };
    const std::size_t sizes[3] = {stack.slices, stack.channels, stack.times};
    for (const TiffPlane& plane : planes) {
        stack.planes[(at[2] * stack.channels + at[1]) * stack.slices + at[0]] = plane;
        for (const char name : order) {
            const auto axis = axisOf(name);
            if (++at[axis] < sizes[axis]) break;
            at[axis] = 0;
        }
    }
    return true;
}

std::vector<TiffPlane> planesBehind(const TiffStack& stack, TIFF* file, std::size_t count) {
    const std::optional<std::uint64_t> begin = plainSamplesAt(file, stack.form);
    if (!begin)
        throw std::runtime_error("announces " + std::to_string(count) + " images, holds " +
                                 std::to_string(stack.files[0].pages.size()));
    if (stack.form.form.bytes() == 0) throw std::runtime_error("has pages of no size");
    const double wanted = double(*begin) + double(stack.form.form.bytes()) * double(count);
    wantBytes(double(bytesIn(stack.files[0].path)), wanted, {}, "bytes");
    std::vector<TiffPlane> planes;
    for (std::size_t i = 0; i < count; ++i) planes.push_back({0, 0, i});
    return planes;
}

std::vector<TiffPlane> fittingPages(TiffStack& stack, Source& source) {
    const std::vector<TiffPage>& pages = stack.files[0].pages;
    // The form of which there are most samples: small pictures may stand among slices or before them.
    double most = -1;
    for (const TiffPage& page : pages) {
        double samples = 0;
        for (const TiffPage& other : pages)
            if (other.fits(page) && !other.reduced) samples += double(other.form.bytes());
        if (samples <= most) continue;
        most = samples;
        stack.form = page;
        if (samples == double(page.form.bytes()) * double(pages.size())) break;
    }
    std::vector<TiffPlane> planes;
    std::size_t left = 0, firstLeft = 0;
    const bool allReduced = std::ranges::all_of(pages, &TiffPage::reduced);
    for (std::size_t p = 0; p < pages.size(); ++p) {
        if (pages[p].fits(stack.form) && (allReduced || !pages[p].reduced)) {
            planes.push_back({0, p, 0});
            continue;
        }
        if (left++ == 0) firstLeft = p;
    }
    if (left > 0)
        source.notes.push_back(std::to_string(left) + " of its " + std::to_string(pages.size()) +
                               " pages, of another size or type (page " + std::to_string(firstLeft + 1) + ": " +
                               textOf(pages[firstLeft].form) + "), " + (left == 1 ? "is" : "are") + " left out.");
    return planes;
}

} // namespace tessera::importer
