/// \file What decides how a texture surface becomes force. Source: docs/method.md, "Rendering".
#pragma once

#include <optional>

namespace touchtrial::engine {

/// The rendering models.
enum class ModelKind {
  paper,    ///< force planes beside a wall, as the paper has it
  surface,  ///< the gradient of one potential
};

/// From grey levels to newtons. A model uses its own and leaves the others at 0.
struct Gains {
  double tangential_n = 0.0;  ///< paper: k_t, N per (grey level per pixel), >= 0
  double normal_n = 0.0;      ///< paper: c, N per grey level, >= 0
  double height_mm = 0.0;     ///< surface: alpha, mm per grey level, >= 0

  friend bool operator==(const Gains&, const Gains&) = default;
};

/// Whether stimuli keep their differences in strength.
enum class Equalise { none, rms };

/// The load at which the stiffness and the lateral forces of `surface` are stated, N: what a hand
/// presses with when it feels a texture.
inline constexpr double kStatedLoadN = 0.7;

/// The study file's "rendering" object.
struct RenderingOptions {
  ModelKind model = ModelKind::paper;
  double pitch_mm = 0.2;                    ///< > 0
  double stiffness_n_per_mm = 0.4;          ///< k of the wall, > 0
  double damping_n_s_per_mm = 0.0;          ///< of the wall, >= 0
  double filter_mm = 0.4;                   ///< reconstruction filter's standard deviation, >= 0
  double texture_stiffness_n_per_mm = 0.4;  ///< the stiffness budget, > 0
  std::optional<Gains> gains;               ///< explicit gains; empty: from the budget
  Equalise equalise = Equalise::none;
  double reference_grey = 128.0;  ///< paper: G_ref, grey levels, 0 .. 255
  double friction = 0.0;          ///< surface: mu of the bristle, >= 0; 0: none
  int neighbourhood = 3;          ///< paper: n, odd, >= 3
  double max_force_n = 3.3;       ///< limit of the total force's norm, > 0

  friend bool operator==(const RenderingOptions&, const RenderingOptions&) = default;
};

}  // namespace touchtrial::engine
