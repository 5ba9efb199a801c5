#include "bench/cases/cases.hpp"

#include "bench/measure/simd_target.hpp"

namespace touchtrial::bench {
namespace {

void append(const Cases& from, Cases& to) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

std::string our_name(const std::string& target) {
  return target.empty() ? "touchtrial" : "touchtrial " + instruction_set_of(target);
}

Cases all_cases(const Scope& scope) {
  Cases cases;
  append(gl_cases(scope), cases);
  append(daub4_cases(scope), cases);
  append(extraction_cases(scope), cases);
  append(ms_ssim_cases(scope), cases);
  append(glcm_cases(scope), cases);
  append(fft_cases(scope), cases);
  append(tv_gabor_cases(scope), cases);
  append(force_cases(), cases);
  append(falcon_cases(), cases);
  append(limit_cases(scope), cases);
  return cases;
}

}  // namespace touchtrial::bench
