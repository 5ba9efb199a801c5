/// \file What is measured: a piece of work, done by the engine or by a peer.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace touchtrial::bench {

/// Errors and times that were not taken.
inline constexpr double kNotTaken = std::numeric_limits<double>::quiet_NaN();

/// A piece of work with its inputs and outputs, ready to run again and again.
struct Job {
  std::function<void()> run;  ///< writes over the outputs of the run before; allocates no planes
  /// How far the last run's outputs are from the same in double; empty if there is no such thing.
  std::function<double()> error;
  int operations = 1;  ///< in one run: times are divided by it
};

/// How errors are measured, and how large they may be.
struct Accuracy {
  std::string unit;        ///< for instance "grey levels"
  double tolerance = 0.0;  ///< an error beyond this means that something else is computed
};

/// A job before it is made. Its inputs are in memory only while it is measured.
struct Case {
  std::string work;    ///< for instance "G-L adaptive"
  std::string who;     ///< for instance "OpenCV filter2D"
  std::string input;   ///< type of the image's samples: "u8" or "f32"; "" if there is none
  int size_px = 0;     ///< side of the square image; 0 if there is none
  int radius = 0;      ///< K; 0 if it has no meaning
  std::string target;  ///< the SIMD target to run on; "": the best
  Accuracy accuracy;
  bool is_slow = false;  ///< a few repetitions must do
  std::function<Job()> make;
};

using Cases = std::vector<Case>;

/// A case that needs its `make` yet.
/// \param radius  0 where it has no meaning
[[nodiscard]] Case case_on_image(std::string work, std::string who, std::string input, int size_px,
                                 int radius, Accuracy accuracy);

/// "G-L adaptive/touchtrial AVX2/u8/500/K=2": names a case among all.
[[nodiscard]] std::string name_of(const Case& one);

}  // namespace touchtrial::bench
