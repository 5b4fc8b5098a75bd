#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace tessera {

/// Numbers that take this program long to compute, and that depend on nothing but the program: computed once, then read
/// from a file of the folder (the user's cache, say; "" keeps nothing). The file counts for this very program alone, as
/// it was built: another one, a file of another length and a damaged one are computed anew and replaced. Where the file
/// cannot be written, nothing is kept.
///
/// `name`: of what is computed. `count`: how many numbers it has.
std::vector<float> computedOnce(const std::string& folder, const std::string& name, std::size_t count,
                                const std::function<std::vector<float>()>& compute);

} // namespace tessera
