/// \file Finds the known name nearest to a misspelt one, for "did you mean" in messages.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace touchtrial {

/// The fewest insertions, deletions, replacements and swaps of neighbouring characters that turn
/// one name into the other (optimal string alignment). Ignores case, and treats `_`, `-` and blanks
/// as equal, because confusing them is not a misspelling.
[[nodiscard]] int edit_distance(std::string_view a, std::string_view b);

/// \return the nearest known name, the first if several are equally near; nothing if more than a
///   third of its characters (and more than one) would have to change
[[nodiscard]] std::optional<std::string_view> nearest_name(
    std::string_view name, std::span<const std::string_view> known_names);

/// Finds the nearest name of a product or model. Ignores dots, dashes and blanks. Prefers a name
/// that differs only by these, then the name without its number ("omega" for "omega.9"); never
/// returns a name with another number.
[[nodiscard]] std::optional<std::string_view> nearest_product(
    std::string_view name, std::span<const std::string_view> known_names);

}  // namespace touchtrial
