#include "bench/case.hpp"

#include <utility>

namespace touchtrial::bench {

Case case_on_image(std::string work, std::string who, std::string input, int size_px, int radius,
                   Accuracy accuracy) {
  Case one;
  one.work = std::move(work);
  one.who = std::move(who);
  one.input = std::move(input);
  one.size_px = size_px;
  one.radius = radius;
  one.accuracy = std::move(accuracy);
  return one;
}

std::string name_of(const Case& one) {
  std::string name = one.work + "/" + one.who;
  if (!one.input.empty()) name += "/" + one.input;
  if (one.size_px > 0) name += "/" + std::to_string(one.size_px);
  if (one.radius > 0) name += "/K=" + std::to_string(one.radius);
  return name;
}

}  // namespace touchtrial::bench
