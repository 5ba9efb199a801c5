#include "analysis/outcomes/demographics.hpp"

#include "support/catch.hpp"

#include <vector>

namespace touchtrial {
namespace {

using analysis::Characteristic;
using analysis::Demographics;

void add(std::vector<Demographics>& people, int n, const Demographics& one) {
  people.insert(people.end(), static_cast<std::size_t>(n), one);
}

}  // namespace

TEST_CASE("bands of fewer than five people are never shown, nor told by what is left") {
  std::vector<Demographics> people;
  add(people, 9, {"20-29", "woman", 80.0});
  add(people, 6, {"30-39", "man", 80.0});
  add(people, 2, {"40-49", "man", -80.0});
  const std::vector<Characteristic> all = analysis::banded_characteristics(people);
  REQUIRE(all.size() == 3);
  // Two of 17 would be told by 9 and 6, so that the six stand with them.
  REQUIRE(all[0].bands.size() == 1);
  CHECK(all[0].name == "age");
  CHECK(all[0].bands[0].name == "20-29");
  CHECK(all[0].bands[0].people == 9);
  CHECK(all[0].others == 8);
  CHECK(all[1].bands.size() == 2);
  CHECK(all[1].others == 0);
  CHECK(all[2].bands.empty());  // fifteen right-handed people would tell that two are not
  CHECK(all[2].others == 17);
}

TEST_CASE("a characteristic of few people is named without numbers, one that nobody told is not") {
  CHECK(analysis::banded_characteristics({}).empty());
  CHECK(analysis::banded_characteristics(std::vector<Demographics>(20)).empty());
  std::vector<Demographics> people;
  add(people, 4, {"20-29", "woman", 80.0});
  for (const Characteristic& one : analysis::banded_characteristics(people))
    CHECK(one.bands.empty());
  add(people, 1, {"20-29", "man", 0.0});
  const std::vector<Characteristic> all = analysis::banded_characteristics(people);
  REQUIRE(all.size() == 3);
  CHECK(all[0].bands.at(0).people == 5);
  CHECK(all[0].others == 0);
  CHECK(all[1].bands.empty());
}

}  // namespace touchtrial
