/// \file What a C++ file includes, and what it defines in its namespaces, read well enough for this
/// project's own sources: macros are not expanded, and of the conditions only `#if 0` is known.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::house {

/// A type, a function or a variable that a file defines, under its qualified name.
struct Definition {
  enum class Kind { type, function, variable };
  Kind kind{};               ///< an alias and a concept count as types
  std::string name;          ///< for instance "touchtrial::store::StudyStore"; a C function's has
                             ///< no namespace and begins with `extern "C"`
  std::string parameters;    ///< of a function: their types, as written but for white space
  bool is_internal = false;  ///< static, constant or anonymous: of its translation unit alone
  std::string aliased;       ///< what an alias stands for, as written; "" if it is none
};

struct Declarations {
  std::vector<Definition> definitions;
  /// Qualified, and whether it holds more than forward declarations of types. What an anonymous
  /// namespace holds, the one around it holds.
  std::map<std::string, bool> namespaces;
  std::vector<std::string> used_namespaces;  ///< by `using namespace`, outside of functions
  std::vector<std::string> includes;         ///< as written: "a.hpp" or <a>, with these marks
  bool is_complete = true;                   ///< every bracket has its partner
};

/// Reads a header or a source. Members that are defined in their class are left out.
[[nodiscard]] Declarations declarations_in(std::string_view text);

}  // namespace touchtrial::house
