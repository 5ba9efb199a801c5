/// \file The extraction methods, their parameters and their names.
/// Source: docs/method.md, "Options", "TV-Gabor", "Other extractors" and "Controls".
#pragma once

#include "core/named.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::engine {

/// How a texture is extracted from an image.
enum class Method { adaptive, fixed, tv_gabor, gaussian, median, edge, luminance };

/// The method's name in study files and on the command line, for instance "tv-gabor".
[[nodiscard]] std::string_view name_of(Method method);
/// \return nothing if no method has this name
[[nodiscard]] std::optional<Method> method_from_name(std::string_view name);
/// All method names, in the order of the enumeration.
[[nodiscard]] std::vector<std::string> method_names();

/// The parameters of methods; their values are members of ExtractionOptions and TvGaborOptions.
enum class Parameter {
  radius,
  order,
  norm,
  gradient,
  combine,
  levels,
  sigma,
  threshold,
  divisor,
  lambda,
  components,
  gap,
  max_steps
};

/// The methods that have a parameter, in the order of the enumeration.
[[nodiscard]] std::vector<Method> methods_with(Parameter parameter);

/// The normalisation of the fractional mask, which determines the strength of a texture.
enum class Norm {
  additive,  ///< T itself
  sum,  ///< T / S_K: the classical mask divided by its sum; up to (1 - S_K) / S_K times the image
  none  ///< T + S_K (I - mean of the image): the plain mask, which keeps the image's shading
};

/// How a texture becomes an 8-bit picture. Forces are always computed from 128 + T.
enum class Mapping {
  offset,  ///< 128 + T
  abs,     ///< |T|
  stretch  ///< from 0 at the texture's minimum to 255 at its maximum; all 0 if it is flat
};

/// The mask that measures the slope of a sub-band along one axis.
enum class Gradient {
  sobel,    ///< [-1 0 1] across, [1 2 1] along, not normalised
  prewitt,  ///< [-1 0 1] across, [1 1 1] along, not normalised
  central   ///< half the difference of the two neighbours
};

/// How the slopes of all sub-bands are combined into one number.
enum class Combine {
  sum,
  l2,  ///< root of the sum of squares
  max
};

/// The control stimulus computed from a texture.
enum class Control {
  none,            ///< the texture itself
  phase_scrambled  ///< the same spectrum with random phases: no structure
};

inline constexpr auto kNormNames = std::to_array<Named<Norm>>(
    {{"additive", Norm::additive}, {"sum", Norm::sum}, {"none", Norm::none}});
inline constexpr auto kMappingNames = std::to_array<Named<Mapping>>(
    {{"offset", Mapping::offset}, {"abs", Mapping::abs}, {"stretch", Mapping::stretch}});
inline constexpr auto kGradientNames = std::to_array<Named<Gradient>>(
    {{"sobel", Gradient::sobel}, {"prewitt", Gradient::prewitt}, {"central", Gradient::central}});
inline constexpr auto kCombineNames = std::to_array<Named<Combine>>(
    {{"sum", Combine::sum}, {"l2", Combine::l2}, {"max", Combine::max}});
inline constexpr auto kControlNames = std::to_array<Named<Control>>(
    {{"none", Control::none}, {"phase-scrambled", Control::phase_scrambled}});

/// One oscillation of the Gabor kernel.
struct GaborComponent {
  double frequency_cycles_per_px = 0.25;  ///< (0, 0.5]
  double direction_deg = 0.0;             ///< finite; direction of oscillation, from x towards y

  friend bool operator==(const GaborComponent&, const GaborComponent&) = default;
};

struct TvGaborOptions {
  /// Beyond these limits the texture contains the whole image, or is too weak to be felt.
  static constexpr double kMinLambda = 1e-6;
  static constexpr double kMaxLambda = 1e6;

  double lambda = 0.01;  ///< weight of the texture norm, kMinLambda .. kMaxLambda
  std::vector<GaborComponent> components = {
      {0.25, 0.0}, {0.25, 45.0}, {0.25, 90.0}, {0.25, 135.0}};  ///< at least one, unless automatic
  double gap = 1e-5;     ///< the relative primal-dual gap at which the iteration stops, > 0
  int max_steps = 2000;  ///< >= 1
  /// Uses the image's strongest oscillation as the only component and ignores `components`.
  bool automatic = false;

  friend bool operator==(const TvGaborOptions&, const TvGaborOptions&) = default;
};

/// Everything that determines a texture. Methods ignore parameters that they do not have.
struct ExtractionOptions {
  static constexpr int kMaxRadius = 63;
  static constexpr int kMaxLevels = 8;
  static constexpr double kMaxSigma_px = 1000.0;
  static constexpr double kMinDivisor = 0.001;
  static constexpr double kMaxDivisor = 1e6;

  Method method = Method::adaptive;
  int radius = 2;              ///< K (adaptive, fixed), or of the window (median); 1 .. kMaxRadius
  double order = 0.5;          ///< v in [0, 1) (fixed)
  Norm norm = Norm::additive;  ///< (adaptive, fixed)
  Gradient gradient = Gradient::sobel;  ///< (adaptive)
  Combine combine = Combine::sum;       ///< (adaptive)
  int levels = 1;                       ///< of sub-bands, J, 1 .. kMaxLevels (adaptive)
  double sigma_px = 2.0;                ///< (0, kMaxSigma_px] (gaussian)
  double threshold_grey = 4.0;          ///< [0, 255] (median)
  double divisor = 4.0;                 ///< kMinDivisor .. kMaxDivisor (edge)
  TvGaborOptions tv_gabor{};
  Control control = Control::none;  ///< computed from the texture (every method)
  std::uint64_t control_seed = 0;   ///< of the phases (Control::phase_scrambled)

  friend bool operator==(const ExtractionOptions&, const ExtractionOptions&) = default;
};

/// Checks the options as extract_texture() does, without an image. Ignores parameters that the
/// method does not have.
/// \throws std::invalid_argument "<parameter>: must be <range>, not <value>"
void check_options(const ExtractionOptions& options);

}  // namespace touchtrial::engine
