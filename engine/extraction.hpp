/// \file From an image to its texture, by any method: the engine's front door.
/// Source: docs/method.md.
#pragma once

#include "core/plane.hpp"
#include "engine/extraction_choices.hpp"
#include "engine/force_field.hpp"
#include "engine/stage_log.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::engine {

/// How a texture is taken from an image (docs/method.md, "Extraction", "TV-Gabor" and "Other
/// extractors").
enum class Method { adaptive, fixed, tv_gabor, gaussian, median, edge, luminance };

/// The name used in study files and on the command line, for instance "tv-gabor".
[[nodiscard]] std::string_view name_of(Method method);
[[nodiscard]] std::optional<Method> method_from_name(std::string_view name);
/// All method names, in the order of the enumeration.
[[nodiscard]] std::vector<std::string> method_names();

/// One (frequency, direction) component of the Gabor kernel.
struct GaborComponent {
  double frequency_cycles_per_px = 0.25;  ///< (0, 0.5]
  double direction_deg = 0.0;             ///< finite; of the oscillation, from x towards y

  friend bool operator==(const GaborComponent&, const GaborComponent&) = default;
};

struct TvGaborOptions {
  /// Beyond these the result is a limit: nothing but texture, or none that a hand could feel.
  static constexpr double kMinLambda = 1e-6;
  static constexpr double kMaxLambda = 1e6;

  double lambda = 0.01;  ///< weight of the texture norm, kMinLambda .. kMaxLambda
  std::vector<GaborComponent> components = {
      {0.25, 0.0}, {0.25, 45.0}, {0.25, 90.0}, {0.25, 135.0}};  ///< at least one, unless automatic
  double gap = 1e-5;     ///< stop at this relative primal-dual gap, > 0
  int max_steps = 2000;  ///< >= 1
  /// Take the image's strongest oscillation as the only component, whatever `components` holds.
  bool automatic = false;

  friend bool operator==(const TvGaborOptions&, const TvGaborOptions&) = default;
};

/// Everything that decides a texture. Only the options of the chosen method matter.
struct ExtractionOptions {
  static constexpr int kMaxRadius = 63;
  static constexpr int kMaxLevels = 8;
  static constexpr double kMaxSigma_px = 1000.0;
  static constexpr double kMinDivisor = 0.001;
  static constexpr double kMaxDivisor = 1e6;

  Method method = Method::adaptive;
  int radius = 2;              ///< K, 1 .. kMaxRadius (adaptive, fixed); of median's window
  double order = 0.5;          ///< v in [0, 1) (fixed)
  Norm norm = Norm::additive;  ///< (adaptive, fixed)
  Gradient gradient = Gradient::sobel;  ///< (adaptive)
  Combine combine = Combine::sum;       ///< (adaptive)
  int levels = 1;                       ///< of sub-bands, J, 1 .. kMaxLevels (adaptive)
  double sigma_px = 2.0;                ///< (0, kMaxSigma_px] (gaussian)
  double threshold_grey = 4.0;          ///< [0, 255] (median)
  double divisor = 4.0;                 ///< kMinDivisor .. kMaxDivisor (edge)
  TvGaborOptions tv_gabor;
  Control control = Control::none;  ///< made of the method's texture (every method)
  std::uint64_t control_seed = 0;   ///< of the phases (Control::phase_scrambled)

  friend bool operator==(const ExtractionOptions&, const ExtractionOptions&) = default;
};

/// Refuses what extract_texture would refuse, before there is an image. Options of other methods
/// than the chosen one are not looked at.
/// \throws std::invalid_argument "<option>: must be <range>, not <value>"
void check_options(const ExtractionOptions& options);

/// Which by-products to keep; a stage that nothing needs is not computed.
struct WantedPlanes {
  bool sub_bands = false;
  bool csgv = false;
  bool order = false;
  bool enhanced = false;
  bool cartoon = false;
  bool picture = false;
  bool force = false;

  [[nodiscard]] static WantedPlanes all() { return {true, true, true, true, true, true, true}; }
};

/// What an extraction gives. Planes that were not wanted, or that the method does not have, are
/// empty (0 x 0). All have the image's shape but for the sub-bands.
template <typename Real>
struct Extraction {
  /// T, grey levels, 0 where the image is flat; v for tv-gabor. With a control, and picture, force
  /// and enhanced with it, that of the control; the other planes are the method's.
  Plane<Real> texture;
  /// Adaptive only, of the first level; ceil(H/2) x ceil(W/2). The first letter is the filter along
  /// x.
  Plane<Real> sub_band_ll, sub_band_lh, sub_band_hl, sub_band_hh;
  Plane<Real> csgv;      ///< composite sub-band gradient, >= 0 (adaptive)
  Plane<Real> order;     ///< v in [0, 1); one value everywhere for fixed (adaptive, fixed)
  Plane<Real> enhanced;  ///< image + T (every method)
  Plane<Real> cartoon;   ///< u = image - v (tv-gabor)
  GreyImage picture;     ///< texture_picture() with its default mapping (every method)
  /// tangential_force() of the texture, 3 x 3, which is that of 128 + T too (every method).
  ForceField<Real> force;
  std::vector<GaborComponent> components;  ///< those used; none if the image is flat (tv-gabor)
  double gap = 0.0;                        ///< relative gap reached (tv-gabor)
  int steps = 0;                           ///< iterations used (tv-gabor)
  bool converged = true;                   ///< false if tv-gabor stopped at max_steps
};

/// Takes the texture from an image. Real is float or double: the precision of the planes. A float
/// texture lies within 4e-5 grey levels of the double one (adaptive, fixed with the norm additive);
/// with other norms and methods but tv-gabor it is the double one rounded.
/// \param image  8-bit grey, at least 1 x 1
/// \throws std::invalid_argument if the image is empty or an option is out of range or NaN, or if
///   tv-gabor is to choose its component and the image has less than 3 pixels on each side
/// \param log  takes the stages, if there is one; bytes are those of their planes
/// Thread-safe. A tv-gabor that stops at max_steps is no error: see Extraction::converged.
template <typename Real>
[[nodiscard]] Extraction<Real> extract_texture(const GreyImage& image,
                                               const ExtractionOptions& options,
                                               const WantedPlanes& wanted = {},
                                               StageLog* log = nullptr);

/// The same into an extraction made before: planes that have the right shape already are written
/// over, so that a series of images of one size allocates next to nothing (float; adaptive and
/// fixed with their default norm, gradient, combine and levels).
template <typename Real>
void extract_texture_into(const GreyImage& image, const ExtractionOptions& options,
                          const WantedPlanes& wanted, Extraction<Real>& result,
                          StageLog* log = nullptr);

/// Turns a method's texture into its control, if the options ask for one.
template <typename Real>
void apply_control(const ExtractionOptions& options, Plane<Real>& texture, StageLog* log = nullptr);

/// The texture as an 8-bit picture, rounded half up and limited to 0 .. 255.
/// \throws std::invalid_argument if the texture is empty or not finite
template <typename Real>
[[nodiscard]] GreyImage texture_picture(const Plane<Real>& texture,
                                        Mapping mapping = Mapping::offset);

/// The surface that forces are made from: 128 + T, unrounded.
/// \throws std::invalid_argument if the texture is empty or not finite
template <typename Real>
[[nodiscard]] Plane<Real> texture_surface(const Plane<Real>& texture);

}  // namespace touchtrial::engine
