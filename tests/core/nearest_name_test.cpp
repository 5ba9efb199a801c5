#include "core/nearest_name.hpp"

#include "support/catch.hpp"

#include <array>
#include <string>

namespace touchtrial {

TEST_CASE("edit_distance counts insertions, deletions, replacements and swaps") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("radius", "radius") == 0);
  CHECK(edit_distance("radus", "radius") == 1);
  CHECK(edit_distance("radiius", "radius") == 1);
  CHECK(edit_distance("rabius", "radius") == 1);
  CHECK(edit_distance("raduis", "radius") == 1);
  CHECK(edit_distance("kitten", "sitting") == 3);
}

TEST_CASE("edit_distance is symmetric and obeys the triangle inequality on short names") {
  const std::array<std::string, 6> names = {"", "gap", "gains", "order", "border", "repeats"};
  for (const auto& a : names) {
    for (const auto& b : names) {
      CHECK(edit_distance(a, b) == edit_distance(b, a));
      for (const auto& c : names) {
        CHECK(edit_distance(a, c) <= edit_distance(a, b) + edit_distance(b, c));
      }
    }
  }
}

TEST_CASE("capitals and the kind of dash do not count") {
  CHECK(edit_distance("De_Bruijn", "de-bruijn") == 0);
  CHECK(edit_distance("no response", "no-response") == 0);
}

TEST_CASE("nearest_name finds a misspelt name, and nothing for an unrelated one") {
  constexpr std::array<std::string_view, 3> kKnown = {"gap", "gains", "max_steps"};
  CHECK(nearest_name("gian", kKnown) == std::nullopt);
  CHECK(nearest_name("gain", kKnown) == "gains");
  CHECK(nearest_name("maxsteps", kKnown) == "max_steps");
  CHECK(nearest_name("temperature", kKnown) == std::nullopt);
  CHECK(nearest_name("", kKnown) == std::nullopt);
  CHECK(nearest_name(std::string(100'000, 'g'), kKnown) == std::nullopt);
}

TEST_CASE("nearest_product prefers a name that differs by signs alone, and no other number") {
  constexpr std::array<std::string_view, 5> kKnown = {"touch", "touch_x", "omega", "delta",
                                                      "omega_3"};
  CHECK(nearest_product("touchx", kKnown) == "touch_x");
  CHECK(nearest_product("omega.3", kKnown) == "omega_3");
  CHECK(nearest_product("delta.3", kKnown) == "delta");
  CHECK(nearest_product("omega.7", kKnown) == "omega");
  CHECK(nearest_product("omega.7", std::array<std::string_view, 1>{"omega_3"}) == std::nullopt);
}

}  // namespace touchtrial
