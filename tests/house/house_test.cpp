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

TEST_CASE("every source lies in a room, and is read") {
  CHECK(product().not_read() == Lines{});
}

TEST_CASE("a source beside the rooms, or with an unknown ending, is found") {
  const PlantedHouse planted{{"core/a.hpp", header("touchtrial", "")},
                             {"engine/old.h", ""},
                             {"protocols/identification/beside.cpp", ""}};
  CHECK(planted.read().not_read() == Lines{"engine/old.h ends neither in .hpp nor in .cpp",
                                           "protocols/identification/beside.cpp lies in no room"});
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

TEST_CASE("no two files define a type, a function or a variable of one qualified name") {
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
              "type touchtrial::app::Path of folder app is defined in app/c.cpp app/d.cpp",
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

TEST_CASE("whatever a header can define, and another too, is found") {
  const std::string defined = GENERATE(
      as<std::string>{}, "typedef int Name;", "typedef struct { int a; } Name;",
      "typedef void (*Name)(int);", "typedef int Name[3];",
      "template <typename T>\nusing Name = std::vector<T>;", "union Name { int a; float b; };",
      "enum Name : int { left };", "enum class Name { left };",
      "template <typename T>\nconcept Name = requires(T t) { t.size(); };",
      "template <typename T>\n  requires std::integral<T> && (sizeof(T) > 4)\nstruct Name {};",
      "template <typename T>\n  requires requires(T t) { t.size(); }\nclass Name {};",
      "template <bool kLarge = (2 > 1)>\nstruct Name {};", "constexpr int Name = 3;",
      "inline constexpr std::array<int, 2> Name{1, 2};", "const std::string Name = \"{\";",
      "template <typename T>\nconstexpr bool Name = false;", "inline int (*Name)(int) = nullptr;",
      "typedef std::map<int, std::vector<int>> Name;", "typedef struct Tag Name;",
      "using Name [[deprecated]] = int;", "enum struct Name {};", "alignas(16) inline int Name[4];",
      "template <template <typename> class C, typename... T>\nstruct Name {};",
      "struct [[nodiscard(\"}\")]] Name : decltype(base)::type {};",
      "inline thread_local int Name [[maybe_unused]] = 3;", "union { int a; } Name;",
      "extern const int Name = 3;", "inline const auto Name = [](int x) { return x; };");
  const std::string body = in("touchtrial::analysis", defined);
  CAPTURE(defined);
  const Lines found =
      PlantedHouse{{"analysis/a.hpp", body}, {"analysis/b.hpp", body}}.read().names_defined_twice();
  REQUIRE(found.size() == 1);
  CHECK(
      found[0].ends_with(" touchtrial::analysis::Name is defined in analysis/a.hpp "
                         "analysis/b.hpp"));
}

TEST_CASE("a function that two files define is found, however it is written") {
  const std::string defined = GENERATE(
      as<std::string>{}, "inline Name::~Name() = default;", "int Name(int x) { return x; }",
      "template <typename T>\n  requires std::integral<T>\nint Name(T x) { return x; }",
      "template <typename T>\nint Name(T x)\n  requires requires { x.y(); }\n{ return x; }",
      "inline Name::Name(int x) : x_{x}, y_(x) {}",
      "[[nodiscard]] inline auto Name([[maybe_unused]] int x) -> std::vector<int> { return {}; }",
      "template <std::size_t n = (3 > 2)>\nvoid Name() {}",
      "inline Name::operator bool() const noexcept(true) { return true; }",
      "inline Name& Name::operator=(const Name& other) { return *this; }",
      "inline int Name() try { return 1; } catch (...) { return 2; }",
      "MACRO(before)\ninline int Name(int x) { return x; }",
      "inline int Name(int x) MACRO { return x; }", "decltype(auto) Name() { return (1); }",
      "auto Name(int a, int b) -> decltype(a < b) { return a < b; }",
      "inline Name::Name() noexcept : a_{}, b_<int>{} {}", "void Name(int) = delete;",
      "inline void Name(std::function<void(int)> f = [](int) {}) { f(1); }",
      "__attribute__((noinline)) inline void Name() {}");
  const std::string body = in("touchtrial::analysis", defined);
  CAPTURE(defined);
  const Lines found =
      PlantedHouse{{"analysis/a.hpp", body}, {"analysis/b.hpp", body}}.read().names_defined_twice();
  REQUIRE(found.size() == 1);
  CHECK(found[0].starts_with("function touchtrial::analysis::Name"));
}

TEST_CASE("what only looks like a definition is none") {
  const std::string declared = GENERATE(
      as<std::string>{}, "class Name;", "template <typename T>\nstruct Name;",
      "enum class Name : int;", "extern int Name;", "int Name(int x = 3);",
      "extern template class Name<int>;", "template class Name<int>;",
      "template <typename T>\nName(T) -> Name<T>;", "static_assert(sizeof(Name) > 3);",
      "using std::Name;", "MACRO(Name);", "// struct Name {};", "/* struct Name {}; */",
      "const char* text();  // R\"(\n// struct Name {}; )\"", "#define NAME \\\n  struct Name {};",
      "#define NAME /*\n*/ struct Name {}", "#if 0\nstruct Name {};\n#endif",
      "#if 0\n#if 1\n#else\nstruct Name {};\n#endif\ndon't\n#endif", "friend class Name;",
      "std::vector<int> Name();");
  const std::string body = in("touchtrial::analysis", declared);
  CAPTURE(declared);
  const House house = PlantedHouse{{"analysis/a.hpp", body}, {"analysis/b.hpp", body}}.read();
  CHECK(house.names_defined_twice() == Lines{});
  CHECK(house.unguarded_or_unexplained_headers() == Lines{});
}

TEST_CASE("whatever stands before a definition, it is found and nothing else is") {
  const std::string before = GENERATE(
      as<std::string>{}, "inline const char* first() { return u8R\"x(\" } )\" } )x\"; }",
      "inline const char* first() { return LR\"( { )\"; }", "inline char first() { return '{'; }",
      "inline int first() { return 1'000'000; }", "#error don't {\n", "#define OPEN {\n",
      "#define LONG \\\r\n  {\r\n", "#if 0\n{ don't \"\n#else\n#endif",
      "template <int n = (1 >> 2)>\nint declared(int m = (n > 3));",
      "template <typename T, std::enable_if_t<(sizeof(T) > 1), int> = 0>\nint declared();",
      "bool operator<(const First& a, const First& b);", "bool operator()(int x);",
      "First& operator<<(First& a, int b);", "int operator\"\"_mm(unsigned long long n);",
      "class First::Inner;", "extern \"C\" {\nvoid first(int);\n}",
      "void first(int) noexcept(sizeof(int) > 3);", "[[deprecated(\"{\")]] void first();",
      "inline auto first = [](int a) { return a > 0 ? 1 : 2; };",
      "std::function<auto(int)->int> first();", "struct alignas(8) First {} first;",
      "enum { a, b };", "template <auto n = [] { return 1; }()>\nvoid first();",
      "inline int first(int a) { return a < 1 || a > 2; }", "asm(\"{\");", "inline int first(3);",
      "using first = decltype([] { return 1; });", "extern \"C++\" {\nint first();\n}",
      "void* operator new[](std::size_t size);", "explicit First(int) -> First<int>;",
      "#include <a>\n#pragma once", "inline std::string first = \"\\\"{\" \"{\";",
      "inline bool first = 1 < 2 && 3 > 2;", "inline namespace first {\nint f();\n}",
      "namespace fs = std::filesystem;", "inline auto first = 1.5e-3'0 + 0x1'F;");
  CAPTURE(before);
  const std::string both = " is defined in analysis/a.hpp analysis/b.hpp";
  const PlantedHouse planted{
      {"analysis/a.hpp", in("touchtrial::analysis", before + "\nstruct Name {};")},
      {"analysis/b.hpp", in("touchtrial::analysis", "struct Name {};")}};
  CHECK(planted.read().names_defined_twice() == Lines{"type touchtrial::analysis::Name" + both});
  CHECK(planted.read().unguarded_or_unexplained_headers() == Lines{});
}

TEST_CASE("a type is found under each form of its head and of its namespace") {
  const std::string text = GENERATE(
      as<std::string>{}, "namespace touchtrial::analysis {\nstruct Name {};\n}",
      "namespace touchtrial {\nnamespace analysis {\nstruct Name {};\n}\n}",
      "namespace touchtrial { inline namespace analysis { struct Name {}; } }",
      "namespace touchtrial::inline analysis { struct Name {}; }",
      "namespace [[deprecated]] touchtrial::analysis { struct Name {}; }",
      "namespace touchtrial::analysis {\r\nstruct Name\r\n{\r\n};\r\n}\r\n",
      "namespace touchtrial::analysis { struct /* a */ Name // b\n final /* c */ : Base {}; }",
      "namespace touchtrial::analysis { class alignas(16) [[nodiscard]] Name : A<int>, B {}; }",
      "namespace touchtrial::analysis { class EXPORT Name { class Inner {}; }; }",
      "namespace touchtrial::analysis { class EXPORT(a) Name final {}; }",
      "namespace touchtrial::analysis { struct Name { friend int f() { return 1; } } name; }",
      "namespace touchtrial::analysis { MACRO(a)\nstruct Name {}; }",
      "namespace touchtrial::analysis { extern \"C\" { struct Name {}; } }",
      "struct touchtrial::analysis::Name {};",
      "namespace touchtrial::analysis { enum class Name : std::uint8_t { a, b }; }");
  CAPTURE(text);
  const std::string head = "/// \\file An example.\n#pragma once\n";
  const PlantedHouse planted{{"analysis/a.hpp", head + text},
                             {"analysis/b.hpp", in("touchtrial::analysis", "struct Name {};")}};
  CHECK(planted.read().names_defined_twice() ==
        Lines{"type touchtrial::analysis::Name is defined in analysis/a.hpp analysis/b.hpp"});
  CHECK(planted.read().namespaces_of_other_rooms() == Lines{});
}

TEST_CASE("different names, scopes and parameters are different definitions") {
  const std::string room = "touchtrial::analysis";
  const PlantedHouse planted{
      {"analysis/a.hpp", in(room,
                            "struct A { struct Inner {}; friend int f(A) { return 1; } };\n"
                            "template <>\nstruct Of<int> {};\n"
                            "inline A::A(int x) : same_{x}, other_(x) {}\n"
                            "inline int f(int) { return 1; }\n"
                            "inline int A::f() const { return 1; }\n"
                            "namespace inner {\nstruct Name {};\n}\n"
                            "template <typename T>\nint g(T) requires One<T> { return 1; }\n")},
      {"analysis/b.hpp", in(room,
                            "struct B { struct Inner {}; friend int f(B) { return 2; } };\n"
                            "template <>\nstruct Of<float> {};\n"
                            "inline B::B(int x) : same_{x}, other_(x) {}\n"
                            "inline int f(double) { return 1; }\n"
                            "inline int A::f() { return 1; }\n"
                            "struct Name {};\n"
                            "template <typename T>\nint g(T) requires Two<T> { return 1; }\n")}};
  CHECK(planted.read().names_defined_twice() == Lines{});
}

TEST_CASE("names of a file's own differ within a folder, whose files may be joined") {
  const std::string room = "touchtrial::app";
  const PlantedHouse planted{
      {"app/a.cpp", in(room,
                       "namespace {\nstruct Shape {};\nint side(int x) { return x; }\n"
                       "using Json = nlohmann::json;\nusing Clock = A;\n}\n"
                       "constexpr int kSides = 3;")},
      {"app/b.cpp", in(room,
                       "namespace {\nenum Shape { round };\nusing Json = nlohmann::json;\n"
                       "using Clock = B;\nconstexpr int kSides = 4;\n}\n"
                       "static int side(int y) { return 2 * y; }")},
      {"app/run/c.cpp", in(room, "namespace {\nstruct Shape {};\nusing Clock = C;\n}")},
      {"app/kernel.cpp",
       "#include <hwy/foreach_target.h>\n" + in(room, "namespace {\nstruct Shape {};\n}")}};
  const std::string both = " of folder app is defined in app/a.cpp app/b.cpp";
  CHECK(planted.read().names_defined_twice() ==
        Lines{"function touchtrial::app::side(int )" + both, "type touchtrial::app::Clock" + both,
              "type touchtrial::app::Shape" + both, "variable touchtrial::app::kSides" + both});
}

TEST_CASE("a C function is one in the program, in whatever namespaces") {
  const PlantedHouse planted{
      {"app/a.cpp", in("touchtrial::app", "extern \"C\" void handle(int signal) {}")},
      {"device/b.cpp", "extern \"C\" {\nvoid handle(int) {}\n}" + in("touchtrial::device", "")}};
  CHECK(planted.read().names_defined_twice() ==
        Lines{"function extern \"C\" handle() is defined in app/a.cpp device/b.cpp"});
  CHECK(planted.read().namespaces_of_other_rooms() == Lines{});
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
              "stimuli/none.cpp defines none in no namespace",
              "stimuli/none.cpp does not open namespace touchtrial::stimuli"});
}

TEST_CASE("a header that uses all of a namespace is found, and what hides its namespace") {
  const PlantedHouse planted{
      {"device/anonymous.cpp", in("touchtrial", "namespace {\nstruct Hidden {};\n}") +
                                   in("touchtrial::device", "struct Own {};")},
      {"device/function.hpp", header("touchtrial::device", "int global() { return 1; }")},
      {"device/qualified.hpp",
       header("touchtrial::device", "inline int touchtrial::engine::stray() { return 1; }")},
      {"device/standard.hpp", header("touchtrial::device", "template <>\nstruct std::hash<A> {};")},
      {"device/using.cpp", in("touchtrial::device", "using namespace touchtrial::engine;")},
      {"device/using.hpp", in("touchtrial::device", "using namespace engine;")},
      {"device/variable.hpp", header("touchtrial::device", "constexpr int kGlobal = 3;")}};
  CHECK(planted.read().namespaces_of_other_rooms() ==
        Lines{"device/anonymous.cpp opens namespace touchtrial",
              "device/function.hpp defines global in no namespace",
              "device/qualified.hpp opens namespace touchtrial::engine",
              "device/using.hpp uses all of namespace engine",
              "device/variable.hpp defines kGlobal in no namespace"});
}

TEST_CASE("every include is read, however it is written") {
  const PlantedHouse planted{
      {"core/a.hpp", header("touchtrial",
                            "#include\"engine/a.hpp\"\n  #  include <engine/b.hpp> // b\r\n"
                            "#include /* c */ \"engine/c.hpp\"\n#include \"core/old.h\"\n"
                            "#if 0\n#include \"engine/d.hpp\"\n#endif\n"
                            "// #include \"engine/e.hpp\"\n/*\n#include \"engine/f.hpp\"\n*/")},
      {"core/old.h", ""},
      {"engine/a.hpp", header("touchtrial::engine", "")},
      {"engine/b.hpp", header("touchtrial::engine", "")},
      {"engine/c.hpp", header("touchtrial::engine", "")}};
  CHECK(planted.read().wrong_includes() ==
        Lines{"core/a.hpp includes engine/a.hpp against the arrows",
              "core/a.hpp includes engine/b.hpp against the arrows",
              "core/a.hpp includes engine/c.hpp against the arrows",
              "core/a.hpp includes core/old.h, which is not read: headers end in .hpp"});
}

TEST_CASE("every header of the product guards itself and says what it is for") {
  CHECK(product().unguarded_or_unexplained_headers() == Lines{});
}

TEST_CASE("a header that does not guard itself or say what it is for is found") {
  const PlantedHouse planted{
      {"core/bare.hpp", "namespace touchtrial {}\n"},
      {"core/branches.cpp", "#if A\nstruct B {\n#else\nstruct C {\n#endif\n};"},
      {"core/kernel-inl.hpp", "/// \\file Once for every target.\n"}};
  CHECK(planted.read().unguarded_or_unexplained_headers() ==
        Lines{"core/bare.hpp does not begin by saying what it is for",
              "core/bare.hpp does not guard itself",
              "core/branches.cpp cannot be read: a bracket has no partner"});
}
