#include "core/named.hpp"

#include "support/catch.hpp"

#include <array>
#include <optional>
#include <string_view>

namespace touchtrial {
namespace {

enum class Side { left, right, above };

constexpr auto kSides = std::to_array<Named<Side>>(
    {{"left", Side::left}, {"sinister", Side::left}, {"right", Side::right}});

TEST_CASE("a table of words is read both ways") {
  CHECK(name_in(kSides, Side::right) == "right");
  CHECK(value_in(kSides, "right") == Side::right);
  CHECK(names_in(kSides) == std::array<std::string_view, 3>{"left", "sinister", "right"});
}

TEST_CASE("a value with several words has the first, and all words mean it") {
  CHECK(name_in(kSides, Side::left) == "left");
  CHECK(value_in(kSides, "sinister") == Side::left);
}

TEST_CASE("a value without a word is unknown, and so is a word without a value") {
  CHECK(name_in(kSides, Side::above) == "unknown");
  CHECK(value_in(kSides, "Left") == std::nullopt);
  CHECK(value_in(kSides, "") == std::nullopt);
}

}  // namespace
}  // namespace touchtrial
