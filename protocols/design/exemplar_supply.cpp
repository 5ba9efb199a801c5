#include "protocols/design/exemplar_supply.hpp"

#include <numeric>
#include <span>
#include <string>

namespace touchtrial::design {

int ExemplarSupply::next(int class_index, int method) {
  const std::size_t images = study_.classes[static_cast<std::size_t>(class_index)].images.size();
  if (images == 1) return 0;
  const auto key = std::pair(class_index, method);
  auto deck = decks_.find(key);
  if (deck == decks_.end()) {
    const std::string purpose = "schedule: exemplars of class " + std::to_string(class_index) +
                                ", method " + std::to_string(method) + restart_;
    RandomStream random(study_.seed, purpose, static_cast<std::uint64_t>(enrolment_));
    deck = decks_.emplace(key, Deck{random, {}}).first;
  }
  std::vector<int>& left = deck->second.left;
  if (left.empty()) {
    left.resize(images);
    std::iota(left.begin(), left.end(), 0);
    shuffle(std::span<int>(left), deck->second.random);
  }
  const int exemplar = left.back();
  left.pop_back();
  return exemplar;
}

}  // namespace touchtrial::design
