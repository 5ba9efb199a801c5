/// \file What decides how a texture surface becomes force. Source: docs/method.md, "Rendering
/// models".
#pragma once

#include <optional>

namespace touchtrial {

/// From grey levels to newtons.
struct Gains {
  double tangential_n = 0.0;  ///< k_t, N per (grey level per pixel), >= 0
  double normal_n = 0.0;      ///< c, N per grey level, >= 0

  friend bool operator==(const Gains&, const Gains&) = default;
};

/// Whether stimuli keep their differences in strength.
enum class Equalise { none, rms };

/// The study file's "rendering" object.
struct RenderingOptions {
  double pitch_mm = 0.2;                    ///< > 0
  double stiffness_n_per_mm = 0.4;          ///< k of the wall, > 0
  double damping_n_s_per_mm = 0.0;          ///< of the wall, >= 0
  double filter_mm = 0.4;                   ///< reconstruction filter's standard deviation, >= 0
  double texture_stiffness_n_per_mm = 0.4;  ///< the stiffness budget, > 0
  std::optional<Gains> gains;               ///< explicit gains; empty: from the budget
  Equalise equalise = Equalise::none;
  double reference_grey = 128.0;  ///< G_ref, grey levels, 0 .. 255
  int neighbourhood = 3;          ///< n, odd, >= 3
  double max_force_n = 3.3;       ///< limit of the total force's norm, > 0

  friend bool operator==(const RenderingOptions&, const RenderingOptions&) = default;
};

}  // namespace touchtrial
