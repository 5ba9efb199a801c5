#include "bench/measure/rows.hpp"

#include "bench/measure/google_benchmark.hpp"
#include "bench/measure/simd_target.hpp"
#include "core/errors.hpp"

#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::bench {

double error_of(const Case& one) {
  const ForcedTarget forced(one.target);
  const Job job = one.make();
  if (!job.error) return kNotTaken;
  job.run();
  const double error = job.error();
  if (!(error <= one.accuracy.tolerance)) {
    throw Error(
        fmt::format("{}: is off by {:.3g} {}, where {:.3g} is tolerated; it computes "
                    "something else",
                    name_of(one), error, one.accuracy.unit, one.accuracy.tolerance));
  }
  return error;
}

std::vector<Row> measure_rows(const Cases& cases, const Effort& effort, const Progress& progress) {
  std::vector<Row> rows;
  const int steps = static_cast<int>(cases.size());
  for (const Case& one : cases) {
    rows.push_back({one, kNotTaken, error_of(one)});
    rows.back().what.make = nullptr;
    progress(static_cast<int>(rows.size()), 2 * steps);
  }
  const std::vector<double> times_us = interleaved_times_us(
      cases, effort, [&](int done, int of) { progress(steps + steps * done / of, 2 * steps); });
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].us = times_us[i];
  return rows;
}

}  // namespace touchtrial::bench
