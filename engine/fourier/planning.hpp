/// \file How Fourier transforms are planned: by FFTW's estimate, or by timing with the outcome
/// kept. Source: docs/decisions/0012-measured-transforms.md.
#pragma once

#include <cstddef>
#include <filesystem>

namespace touchtrial::engine {

/// Timing plans takes about as long as some hundred transforms: it pays from here on.
inline constexpr std::size_t kSamplesWorthMeasuring = std::size_t{1} << 18U;

/// From now on transforms of at least `fewest_samples` follow the plan that a file in the folder
/// holds. Where there is none that fits, plans are timed and the outcome is kept, so that every
/// later run on the machine has the same plan, and the same bits. What cannot be kept is not timed
/// but estimated; nothing here is an error. \param folder  made if it is missing; empty: every
/// plan is estimated, the same in every process with the same FFTW and processor, as from the start
/// Affects the whole process, thread-safe; transforms that exist keep their plans.
void use_measured_plans(const std::filesystem::path& folder,
                        std::size_t fewest_samples = kSamplesWorthMeasuring);

/// The user's cache folder for this program: touchtrial in $XDG_CACHE_HOME, else in ~/.cache; empty
/// where neither variable holds an absolute path.
[[nodiscard]] std::filesystem::path user_cache_folder();

}  // namespace touchtrial::engine
