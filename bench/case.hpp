/// \file One case of the benchmark: a piece of work, done by the engine or by a peer.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace touchtrial::bench {

/// The value of errors and times that were not taken.
inline constexpr double kNotTaken = std::numeric_limits<double>::quiet_NaN();

/// A piece of work with its inputs and outputs, ready to run again and again.
struct Job {
  std::function<void()> run;  ///< overwrites the outputs of the previous run; allocates no planes
  /// The error of the last run's outputs against double precision; empty if it has no meaning.
  std::function<double()> error;
  int operations = 1;  ///< in one run; times are divided by it
};

/// The unit of errors, and the largest one.
struct Accuracy {
  std::string unit;        ///< for instance "grey levels"
  double tolerance = 0.0;  ///< a larger error means that the case computes something else
};

/// A job that is not made yet. Its inputs are in memory only while it is measured.
struct Case {
  std::string work;  ///< for instance "G-L adaptive"
  std::string who;   ///< for instance "OpenCV filter2D"
  std::string
      input;  ///< type of the image's samples, for instance "u8" or "f32"; "" without an image
  int size_px = 0;     ///< side of the square image; 0 without an image
  int radius = 0;      ///< K; 0 where it has no meaning
  std::string target;  ///< the SIMD target to run on; "" for the best
  Accuracy accuracy;
  bool is_slow = false;  ///< few repetitions
  std::function<Job()> make;
};

using Cases = std::vector<Case>;

/// A case whose `make` is still to be set.
/// \param radius  0 where it has no meaning
[[nodiscard]] Case case_on_image(std::string work, std::string who, std::string input, int size_px,
                                 int radius, Accuracy accuracy);

/// The unique name of a case, for instance "G-L adaptive/touchtrial AVX2/u8/500/K=2".
[[nodiscard]] std::string name_of(const Case& one);

}  // namespace touchtrial::bench
