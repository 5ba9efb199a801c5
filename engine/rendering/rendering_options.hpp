/// \file The options for rendering a texture as force. Source: docs/method.md, "Rendering".
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

namespace touchtrial::engine {

/// The rendering models. To add one: docs/add-a-rendering-model.md.
enum class ModelKind {
  paper,    ///< a wall and force planes, as in the paper
  surface,  ///< the gradient of a potential
};

/// Factors from grey levels to forces. Each model uses its own gains and leaves the others at 0.
struct Gains {
  double tangential_n = 0.0;  ///< paper: k_t, N per (grey level per pixel), >= 0
  double normal_n = 0.0;      ///< paper: c, N per grey level, >= 0
  double height_mm = 0.0;     ///< surface: alpha, mm per grey level, >= 0

  friend bool operator==(const Gains&, const Gains&) = default;
};

/// A gain and its name in files.
struct NamedGain {
  std::string_view name;
  double Gains::*value;
};
inline constexpr std::array kGains = {NamedGain{"tangential_n", &Gains::tangential_n},
                                      NamedGain{"normal_n", &Gains::normal_n},
                                      NamedGain{"height_mm", &Gains::height_mm}};

[[nodiscard]] inline Gains scaled(Gains gains, double factor) noexcept {
  for (const NamedGain& gain : kGains) gains.*gain.value *= factor;
  return gains;
}

/// Scales by decibels of force amplitude.
[[nodiscard]] inline Gains scaled_db(const Gains& gains, double db) noexcept {
  return scaled(gains, std::pow(10.0, db / 20.0));
}

/// Whether every gain is a finite number >= 0.
[[nodiscard]] inline bool are_valid(const Gains& gains) noexcept {
  for (const NamedGain& gain : kGains) {
    const double value = gains.*gain.value;
    if (!std::isfinite(value) || value < 0.0) return false;
  }
  return true;
}

/// Whether stimuli are equalised in strength. `level` is applied by the code that computes levels,
/// the others by choose_gains().
enum class Equalise { none, rms, level };

/// The load at which stiffness and lateral forces of `surface` are stated, N: typical of texture
/// exploration.
inline constexpr double kReferenceLoadN = 0.7;

/// G where T = 0, grey levels: G = 128 + T.
inline constexpr double kMidGrey = 128.0;

/// The largest neighbourhood of a tangential force that a model evaluates at the stylus.
inline constexpr int kMaxNeighbourhood = 31;

/// The "rendering" object of the study file.
struct RenderingOptions {
  ModelKind model = ModelKind::paper;
  double pitch_mm = 0.2;                    ///< > 0
  double stiffness_n_per_mm = 0.4;          ///< k of the wall, > 0
  double damping_n_s_per_mm = 0.0;          ///< of the wall, >= 0
  double filter_mm = 0.4;                   ///< reconstruction filter's standard deviation, >= 0
  double texture_stiffness_n_per_mm = 0.4;  ///< the stiffness budget, > 0
  std::optional<Gains> gains{};             ///< explicit gains; empty: from the budget
  Equalise equalise = Equalise::none;
  double reference_grey = 128.0;  ///< paper: G_ref, grey levels, 0 .. 255
  double friction = 0.0;          ///< surface: friction coefficient mu, >= 0; 0: no friction
  int neighbourhood = 3;          ///< paper: n, odd, 3 .. kMaxNeighbourhood
  double touchdown_ramp_n = 0.0;  ///< paper: load at which lateral force is full, >= 0; 0: no ramp
  double max_force_n = 3.3;       ///< limit of the total force's norm, > 0

  friend bool operator==(const RenderingOptions&, const RenderingOptions&) = default;
};

}  // namespace touchtrial::engine
