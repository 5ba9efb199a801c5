// The rules of docs/architecture.md, held against the product, and against planted houses that
// break them.
#include "house/house.hpp"

#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::house;

namespace {

namespace fs = std::filesystem;

using Lines = std::vector<std::string>;

const House& product() {
  static const House house(TOUCHTRIAL_SOURCE_DIR);
  return house;
}

/// A house of a few files, each a path and its text.
class PlantedHouse {
 public:
  PlantedHouse(std::initializer_list<std::pair<std::string, std::string>> files) {
    for (const auto& [path, text] : files) {
      fs::create_directories((folder_.path() / path).parent_path());
      std::ofstream(folder_.path() / path) << text;
    }
  }

  House read() const { return House(folder_.path()); }

 private:
  TempFolder folder_;
};

std::string header(const std::string& name_space, const std::string& body,
                   const std::string& purpose = "An example.") {
  return "/// \\file " + purpose + "\n#pragma once\n\n" + body + "\nnamespace " + name_space +
         " {}\n";
}

std::string in(const std::string& name_space, const std::string& body) {
  return "/// \\file An example.\n#pragma once\nnamespace " + name_space + " {\n" + body + "\n}\n";
}

}  // namespace

TEST_CASE("no include runs against the arrows between the folders") {
  REQUIRE(product().files().size() > 50);
  CHECK(product().wrong_includes() == Lines{});
}

TEST_CASE("an include against the arrows is found, and one of what is not there") {
  const PlantedHouse planted{
      {"core/up.hpp", header("touchtrial", "#include \"engine/texture.hpp\"")},
      {"engine/texture.hpp", header("touchtrial::engine", "#include \"core/gone.hpp\"")},
      {"engine/astray.hpp", header("touchtrial::engine", "#include \"docs/page.hpp\"")},
      {"docs/page.hpp", ""}};
  CHECK(planted.read().wrong_includes() ==
        Lines{"core/up.hpp includes engine/texture.hpp against the arrows",
              "engine/astray.hpp includes docs/page.hpp, which is in no room",
              "engine/texture.hpp includes core/gone.hpp, which is not there"});
}

TEST_CASE("the arrows themselves have no cycle") {
  for (const Room& room : rooms()) {
    for (const Room& other : rooms()) {
      INFO(room.folder << " and " << other.folder);
      CHECK_FALSE((room.arrows.count(other.folder) > 0 && other.arrows.count(room.folder) > 0));
    }
  }
}

TEST_CASE("a header that shows a third-party header is private: no other layer includes it") {
  CHECK(product().third_party_headers_shown() == Lines{});
}

TEST_CASE("a third-party header that shows through another header is found") {
  const PlantedHouse planted{
      {"engine/inner.hpp", header("touchtrial::engine", "#include <opencv2/core.hpp>")},
      {"engine/outer.hpp", header("touchtrial::engine", "#include \"engine/inner.hpp\"")},
      {"engine/own.cpp", header("touchtrial::engine", "#include \"engine/outer.hpp\"")},
      {"app/window.cpp", header("touchtrial::app", "#include \"engine/outer.hpp\"")}};
  CHECK(planted.read().third_party_headers_shown() ==
        Lines{"app/window.cpp includes engine/outer.hpp, which shows a third-party header"});
}

TEST_CASE("a protocol's part may use what its layer shows to itself, and no other layer's") {
  const PlantedHouse planted{
      {"analysis/json.hpp", header("touchtrial::analysis", "#include <nlohmann/json.hpp>")},
      {"protocols/design/json.hpp", header("touchtrial::design", "#include <nlohmann/json.hpp>")},
      {"protocols/identification/analysis/report.cpp",
       header("touchtrial::analysis::identification",
              "#include \"analysis/json.hpp\"\n#include \"protocols/design/json.hpp\"")}};
  CHECK(planted.read().third_party_headers_shown() ==
        Lines{"protocols/identification/analysis/report.cpp includes protocols/design/json.hpp, "
              "which shows a third-party header"});
}

TEST_CASE("a header that says it is private to a folder is included from there alone") {
  CHECK(product().private_headers_used_elsewhere() == Lines{});
}

TEST_CASE("a private header that another folder includes is found") {
  const PlantedHouse planted{
      {"engine/rendering/spline.hpp",
       header("touchtrial::engine", "", "A spline. Private to\n/// engine/rendering.")},
      {"engine/rendering/model.cpp",
       header("touchtrial::engine", "#include \"engine/rendering/spline.hpp\"")},
      {"engine/pack/pack.cpp",
       header("touchtrial::engine", "#include \"engine/rendering/spline.hpp\"")},
      {"device/hand.hpp", header("touchtrial::device", "", "A hand. Private to this folder.")},
      {"app/window.cpp", header("touchtrial::app", "#include <device/hand.hpp>")}};
  CHECK(planted.read().private_headers_used_elsewhere() ==
        Lines{"app/window.cpp includes device/hand.hpp, which is private to device",
              "engine/pack/pack.cpp includes engine/rendering/spline.hpp, which is private to "
              "engine/rendering"});
}

TEST_CASE("no two files define a type, an inline function or variable of one qualified name") {
  CHECK(product().names_defined_twice() == Lines{});
}

TEST_CASE("a name that two files define is found") {
  const std::string room = "touchtrial::analysis";
  const PlantedHouse planted{
      {"analysis/a.hpp", in(room,
                            "struct Cue { int a; };\n"
                            "enum class Align { left };\n"
                            "using Path = int;\n"
                            "inline int twice(int x) { return 2 * x; }\n"
                            "template <typename T>\nT half(const T& x) { return x / 2; }\n"
                            "inline constexpr int kSides[] = {1, 2};\n"
                            "[[nodiscard]] int declared_only(int x);\n"
                            "class Forward;\n")},
      {"analysis/b.hpp", in(room,
                            "class [[nodiscard]] Cue final : public Base { double b; };\n"
                            "enum Align : int { right };\n"
                            "using Path = double;\n"
                            "inline int twice(int  x) { return x + x; }\n"
                            "inline int twice(double x) { return 0; }\n"
                            "template <typename T>\nT half(const T& x) { return x; }\n"
                            "inline constexpr int kSides[]{3};\n"
                            "[[nodiscard]] int declared_only(int x);\n"
                            "class Forward;\n")},
      {"app/c.cpp", in("touchtrial::app", "struct Cue {};\nnamespace {\nstruct Path {};\n}\n")},
      {"app/d.cpp", in("touchtrial::app", "namespace {\nstruct Path {};\n}\nstruct Cue {};\n")}};
  const std::string both = " is defined in analysis/a.hpp analysis/b.hpp";
  CHECK(planted.read().names_defined_twice() ==
        Lines{"function touchtrial::analysis::half(const T & )" + both,
              "function touchtrial::analysis::twice(int )" + both,
              "type touchtrial::analysis::Align" + both, "type touchtrial::analysis::Cue" + both,
              "type touchtrial::analysis::Path" + both,
              "type touchtrial::app::Cue is defined in app/c.cpp app/d.cpp",
              "variable touchtrial::analysis::kSides" + both});
}

TEST_CASE("neither names of parameters nor default values make another function") {
  const std::string room = "touchtrial::analysis";
  const PlantedHouse planted{
      {"analysis/a.hpp", in(room,
                            "inline int sum(const Cue& first, int times = 3) { return 1; }\n"
                            "inline bool operator==(const A& x, const A& y) { return true; }\n"
                            "inline bool operator<=(A x, A y) { return true; }\n")},
      {"analysis/b.hpp", in(room,
                            "inline int sum(const Cue& other, int n) { return 2; }\n"
                            "inline bool operator==(const B& x, const B& y) { return true; }\n"
                            "inline bool operator<=(A left, A right) { return false; }\n")}};
  const std::string both = " is defined in analysis/a.hpp analysis/b.hpp";
  CHECK(planted.read().names_defined_twice() ==
        Lines{"function touchtrial::analysis::operator<=(A , A )" + both,
              "function touchtrial::analysis::sum(const Cue & , int )" + both});
}

TEST_CASE("every file's namespace is its room's") {
  CHECK(product().namespaces_of_other_rooms() == Lines{});
}

TEST_CASE("a namespace that is another room's, or none, is found") {
  const PlantedHouse planted{
      {"core/plane.hpp", in("touchtrial", "struct Plane {};")},
      {"core/guest.hpp", in("touchtrial::engine", "struct Guest {};")},
      {"device/forward.hpp",
       in("touchtrial", "class Plane;") + in("touchtrial::device", "struct Forward {};")},
      {"device/falcon/legs.hpp", in("touchtrial::device::falcon", "struct Legs {};")},
      {"engine/flat.hpp", in("touchtrial", "struct Flat {};")},
      {"engine/global.hpp", header("touchtrial::engine", "struct Global {};")},
      {"analysis/planning/power.hpp", in("touchtrial::analysis", "struct Power {};")},
      {"stimuli/none.cpp", "int none() { return 0; }\n"}};
  CHECK(planted.read().namespaces_of_other_rooms() ==
        Lines{"analysis/planning/power.hpp opens namespace touchtrial::analysis",
              "analysis/planning/power.hpp does not open namespace touchtrial::planning",
              "core/guest.hpp opens namespace touchtrial::engine",
              "core/guest.hpp does not open namespace touchtrial",
              "engine/flat.hpp opens namespace touchtrial",
              "engine/flat.hpp does not open namespace touchtrial::engine",
              "engine/global.hpp defines Global in no namespace",
              "stimuli/none.cpp does not open namespace touchtrial::stimuli"});
}

TEST_CASE("every header of the product guards itself and says what it is for") {
  CHECK(product().unguarded_or_unexplained_headers() == Lines{});
}

TEST_CASE("a header that does not guard itself or say what it is for is found") {
  const PlantedHouse planted{{"core/bare.hpp", "namespace touchtrial {}\n"},
                             {"core/kernel-inl.hpp", "/// \\file Once for every target.\n"}};
  CHECK(planted.read().unguarded_or_unexplained_headers() ==
        Lines{"core/bare.hpp does not begin by saying what it is for",
              "core/bare.hpp does not guard itself"});
}
