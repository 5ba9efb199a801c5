#include "bench/case.hpp"

namespace touchtrial::bench {

std::string name_of(const Case& one) {
  std::string name = one.work + "/" + one.who;
  if (!one.input.empty()) name += "/" + one.input;
  if (one.size_px > 0) name += "/" + std::to_string(one.size_px);
  if (one.radius > 0) name += "/K=" + std::to_string(one.radius);
  return name;
}

}  // namespace touchtrial::bench
