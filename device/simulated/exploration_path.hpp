/// \file The path of a simulated hand on a plane: straight lateral strokes between random points.
#pragma once

#include "core/plane_geometry.hpp"
#include "core/random.hpp"
#include "core/vec.hpp"

#include <cstddef>
#include <vector>

namespace touchtrial::device {

struct ExplorationOptions {
  double slowest_mm_s = 50.0;   ///< of a stroke's steady part, > 0
  double fastest_mm_s = 150.0;  ///< >= slowest
  double margin_mm = 8.0;       ///< kept from the plane's edge, >= 0; at most a fifth of a side
  double duration_s = 10.0;     ///< > 0
};

/// Place and speed of the path at one time.
struct PathPoint {
  Vec2 position_mm;
  Vec2 velocity_mm_s;
};

/// Strokes end to end. Each starts and ends at rest, speeds up and slows down smoothly (continuous
/// acceleration), and keeps its speed in between. End points are uniform within the margin and at
/// least half the shorter side apart, so that direction and offset differ with every stroke; speeds
/// are uniform in the range. Strokes are slower on a plane too short for the speed.
class ExplorationPath {
 public:
  /// The time in which a stroke reaches its speed, and that in which it comes to rest.
  static constexpr double kRampS = 0.08;

  /// \throws std::invalid_argument if the plane has no area or an option is out of range
  ExplorationPath(const PlaneGeometry& plane, const ExplorationOptions& options,
                  RandomStream& random);

  /// \param time_s  >= 0, never earlier than in the last call; after the last stroke the path rests
  ///   at its end
  /// \param stroke  the place of the search, which the caller keeps from call to call; 0 at first
  [[nodiscard]] PathPoint at(double time_s, std::size_t& stroke) const noexcept;

 private:
  struct Stroke {
    double start_s = 0.0;
    double steady_s = 0.0;  ///< duration less one ramp, so that length = speed * steady_s
    double speed_mm_s = 0.0;
    Vec2 from_mm;
    Vec2 direction;  ///< of length 1
    [[nodiscard]] double end_s() const noexcept { return start_s + steady_s + kRampS; }
  };
  [[nodiscard]] static Stroke stroke_between(Vec2 from_mm, Vec2 to_mm, double start_s,
                                             double speed_mm_s) noexcept;

  std::vector<Stroke> strokes_;
};

}  // namespace touchtrial::device
