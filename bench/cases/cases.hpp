/// \file The cases of every kernel and its peers.
#pragma once

#include "bench/case.hpp"
#include "bench/peers/opencv_extraction.hpp"

#include <string>
#include <vector>

namespace touchtrial::bench {

/// Sizes, radii and targets of the cases.
struct Scope {
  std::vector<int> sizes_px = {256, 500, 1024, 4096};
  /// Further sizes, of whole extractions only.
  std::vector<int> more_sizes_px = {64, 128, 2048};
  std::vector<int> radii = {1, 2, 3, 7};
  std::vector<std::string> targets;  ///< SIMD targets of the adaptive filter, best first
};

/// The side of a default stimulus.
inline constexpr int kUsualSize_px = 500;
/// The method's default K.
inline constexpr int kUsualRadius = 2;
/// The order of all cases with a fixed order.
inline constexpr double kFixedOrder = 0.55;

/// "touchtrial", or for instance "touchtrial AVX-512" with a SIMD target.
[[nodiscard]] std::string our_name(const std::string& target = {});

[[nodiscard]] Case adaptive_filter_case(int size_px, int radius, const std::string& target);
[[nodiscard]] Case filter2d_case(int size_px, int radius, const std::string& input);
[[nodiscard]] Cases gl_cases(const Scope& scope);

[[nodiscard]] Case daub4_case(int size_px);
[[nodiscard]] Case opencv_daub4_case(int size_px, Daub4Way way);
[[nodiscard]] Cases daub4_cases(const Scope& scope);

/// What an extraction computes besides the texture.
enum class Extras {
  none,
  picture,
  heights,  ///< what the models' forces need: the plane's highest point
  force     ///< force planes, as for dumps
};
[[nodiscard]] Case extraction_case(int size_px, int radius, Extras extras);
[[nodiscard]] Case ring_sums_case(int size_px, int radius, Extras extras, RingSums how);
[[nodiscard]] Cases extraction_cases(const Scope& scope);

template <typename Real>
[[nodiscard]] Case ms_ssim_case(int size_px);
[[nodiscard]] Case opencv_ms_ssim_case(int size_px);
[[nodiscard]] Cases ms_ssim_cases(const Scope& scope);

[[nodiscard]] Case glcm_case(int size_px);
[[nodiscard]] Case pair_loop_case(int size_px);
[[nodiscard]] Cases glcm_cases(const Scope& scope);

[[nodiscard]] Cases fft_cases(const Scope& scope);

/// ADMM in single precision: set-up and this number of steps.
[[nodiscard]] Case admm_case(int size_px, int steps);
/// The transforms of as many steps and their checks, there and back, by measured plans.
[[nodiscard]] Case transforms_case(int size_px, int steps);
[[nodiscard]] Case fixed_point_case(int size_px, int steps);
[[nodiscard]] Cases tv_gabor_cases(const Scope& scope);

[[nodiscard]] Case paper_force_case();
[[nodiscard]] Case surface_force_case();
[[nodiscard]] Cases force_cases();

/// The computations of a Falcon's driver for each reading.
[[nodiscard]] Cases falcon_cases();

/// What the machine cannot do faster (bench/limits): reading a picture and writing a plane, through
/// the caches and past them.
[[nodiscard]] Cases streaming_cases(int size_px);
[[nodiscard]] Case arithmetic_case(int size_px);
/// The engine's hash function, which is a library's.
[[nodiscard]] Case hash_case(int bytes);
[[nodiscard]] Cases limit_cases(const Scope& scope);

/// All of the above.
[[nodiscard]] Cases all_cases(const Scope& scope);

}  // namespace touchtrial::bench
