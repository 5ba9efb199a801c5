#!/usr/bin/env python3
"""house_test.py: tests each rule of house.py with a few files that violate it."""
import pathlib
import tempfile
import unittest

from house import House
import pinned_words

ARCHITECTURE = """
| folder | holds | may use |
| --- | --- | --- |
| `core` | basics | - |
| `engine` | textures | core |
| `device` | devices | core |
| `study` | studies | engine |
| `analysis` | reports | study |
| `analysis/planning` | power | analysis |
| `protocols/identification/analysis` | a part | analysis |
| `app` | commands | analysis/planning, device |
| `bench` | times | app, and private headers of all |
"""


def violations(files, architecture=ARCHITECTURE):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for path, text in files.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text)
        return sorted(House(root, architecture).violations())


def header(space, body="", purpose="An example.", before=""):
    return f"/// \\file {purpose}\n#pragma once\n{before}\nnamespace {space} {{\n{body}\n}}\n"


def including(space, *names):
    return header(space, before="\n".join(f"#include {name}" for name in names))


def pair(one, other=None):
    space = "touchtrial::analysis"
    return {"analysis/a.hpp": header(space, one), "analysis/b.hpp": header(space, other or one)}


class HouseTest(unittest.TestCase):
    def test_sources_outside_rooms_or_with_another_ending(self):
        self.assertEqual(violations({"engine/old.h": "", "protocols/identification/beside.cpp": ""}),
                         ["engine/old.h ends neither in .hpp nor in .cpp",
                          "protocols/identification/beside.cpp is in no room"])

    def test_includes(self):
        engine = header("touchtrial::engine")
        self.assertEqual(violations({
            "core/a.hpp": including("touchtrial", '"engine/a.hpp"', "<engine/b.hpp> // b\r", '/* c */ "core/old.h"',
                                    '"core/gone.hpp"', '"docs/page.hpp"',
                                    '"engine/a.hpp"\n#if 0\n#include "engine/d.hpp"\n#endif\n// #include "engine/e.hpp"'),
            "app/a.hpp": including("touchtrial::app", '"engine/a.hpp"'),  # indirectly allowed
            "core/old.h": "", "docs/page.hpp": "", "engine/a.hpp": engine, "engine/b.hpp": engine}),
            ["core/a.hpp includes core/gone.hpp, which does not exist",
             "core/a.hpp includes core/old.h, which is not read: headers end in .hpp",
             "core/a.hpp includes docs/page.hpp, which is in no room",
             "core/a.hpp includes engine/a.hpp, which its room may not use",
             "core/a.hpp includes engine/a.hpp, which its room may not use",
             "core/a.hpp includes engine/b.hpp, which its room may not use",
             "core/old.h ends neither in .hpp nor in .cpp"])

    def test_circular_and_missing_rooms(self):
        for uses in ("engine", "store"):
            with self.assertRaises(SystemExit):
                violations({}, ARCHITECTURE.replace("| basics | - |", f"| basics | {uses} |"))

    def test_third_party_headers(self):
        self.assertEqual(violations({
            "engine/inner.hpp": including("touchtrial::engine", "<opencv2/core.hpp>"),
            "engine/outer.hpp": including("touchtrial::engine", '"engine/inner.hpp"'),
            "engine/own.cpp": including("touchtrial::engine", '"engine/outer.hpp"'),
            "app/window.cpp": including("touchtrial::app", '"engine/outer.hpp"'),
            "analysis/json.hpp": including("touchtrial::analysis", "<nlohmann/json.hpp>"),
            "protocols/identification/analysis/a.cpp":
                including("touchtrial::analysis::identification", '"analysis/json.hpp"')}),
            ["app/window.cpp includes engine/outer.hpp, which exposes a third-party header"])

    def test_private_headers(self):
        self.assertEqual(violations({
            "engine/fit/spline.hpp": header("touchtrial::engine", purpose="A spline. Private to\n/// engine/fit."),
            "engine/fit/model.cpp": including("touchtrial::engine", '"engine/fit/spline.hpp"'),
            "engine/pack/pack.cpp": including("touchtrial::engine", '"engine/fit/spline.hpp"'),
            "device/hand.hpp": header("touchtrial::device", purpose="A hand. Private to this folder."),
            "app/window.cpp": including("touchtrial::app", "<device/hand.hpp>"),
            "bench/hand.cpp": including("touchtrial::bench", "<device/hand.hpp>")}),
            ["app/window.cpp includes device/hand.hpp, which is private to device",
             "engine/pack/pack.cpp includes engine/fit/spline.hpp, which is private to engine/fit"])

    def test_definitions_in_two_headers(self):
        for defined in (
                "typedef int Name;", "typedef struct { int a; } Name;", "typedef void (*Name)(int);", "typedef int Name[3];",
                "template <typename T>\nusing Name = std::vector<T>;", "union Name { int a; };", "enum class Name : int { a };",
                "template <typename T>\nconcept Name = requires(T t) { t.size(); };", "class EXPORT Name { class Inner {}; };",
                "template <typename T>\n  requires std::integral<T> && (sizeof(T) > 4)\nstruct Name {};",
                "template <typename T>\n  requires requires(T t) { t.size(); }\nclass Name {};",
                "template <bool kLarge = (2 > 1)>\nstruct Name {};", "class [[nodiscard]] Name final : public Base<int>, B {};",
                "struct alignas(16) Name : decltype(base)::type {};", "constexpr int Name = 3;",
                "inline constexpr std::array<int, 2> Name{1, 2};", 'const std::string Name = "{";',
                "inline int (*Name)(int) = nullptr;", "inline const auto Name = [](int x) { return x; };",
                "extern const int Name = 3;", "struct /* a */ Name // b\n final {};", "enum Name { left };\r\n",
                "inline Name::~Name() = default;", "int Name(int x) { return x; }",
                "template <typename T>\nint Name(T x)\n  requires requires { x.y(); }\n{ return x; }",
                "inline Name::Name(int x) : x_{x}, y_(x) {}", "inline Name::operator bool() const noexcept(true) { return 1; }",
                "[[nodiscard]] inline auto Name([[maybe_unused]] int x) -> std::vector<int> { return {}; }",
                "inline Name& Name::operator=(const Name& other) { return *this; }", "void Name(int) = delete;",
                "inline void Name(std::function<void(int)> f = [](int) {}) { f(1); }",
                "template <typename R>\nstd::span<R> Name<R>::row() { return {}; }"):
            for before in ("", "class First;", "enum { a, b };", "int first(int a = {});", "inline int first = (1 < 2);"):
                found = violations(pair(before + defined, defined))
                self.assertEqual(len(found), 1, (before, defined, found))
                self.assertRegex(found[0], r"^\w+ touchtrial::analysis::Name\S*.* is defined in analysis/a.hpp analysis/b.hpp$")

    def test_declarations_are_not_definitions(self):
        for declared in (
                "class Name;", "template <typename T>\nstruct Name;", "enum class Name : int;", "extern int Name;",
                "int Name(int x = 3);", "template class Name<int>;", "static_assert(sizeof(Name) > 3);", "using std::Name;",
                "MACRO(Name);", "/* struct Name {}; */", 'const char* text();  // R"(\n// struct Name {}; )"',
                "#define NAME \\\n  struct Name {};", "#if 0\n#if 1\n#else\nstruct Name {};\n#endif\ndon't\n#endif",
                "std::vector<int> Name(const Options& options = {});"):
            self.assertEqual(violations(pair(declared)), [], declared)

    def test_other_names_scopes_and_parameters(self):
        self.assertEqual(violations(pair(
            "struct A { struct Inner {}; };\ntemplate <>\nstruct Of<int> {};\ninline int f(int) { return 1; }\n"
            "inline int A::f() const { return 1; }\nnamespace inner {\nstruct Name {};\n}\n",
            "struct B { struct Inner {}; };\ntemplate <>\nstruct Of<float> {};\ninline int f(double) { return 1; }\n"
            "inline int A::f() { return 1; }\nstruct Name {};\n")), [])
        self.assertEqual(violations(pair("inline int sum(const Cue& first, int times = 3) { return 1; }",
                                         "inline int sum(const Cue& other, int n) { return 2; }")),
                         ["function touchtrial::analysis::sum(constCue&, int) is defined in analysis/a.hpp analysis/b.hpp"])

    def test_local_names_in_a_folder(self):
        body = "namespace {{\nstruct Shape {{}};\nusing Json = nlohmann::json;\nusing Clock = {0};\n}}\nconstexpr int kSides = 3;"
        self.assertEqual(violations({
            "app/a.cpp": header("touchtrial::app", body.format("A") + "\nstatic int side(int x) { return x; }"),
            "app/b.cpp": header("touchtrial::app", body.format("B") + "\nnamespace {\nint side(int y) { return y; }\n}"),
            "app/run/c.cpp": header("touchtrial::app", body.format("C")),
            "app/kernel.cpp": header("touchtrial::app", body.format("D"), before="#include <hwy/foreach_target.h>")}),
            [f"{name} of folder app is defined in app/a.cpp app/b.cpp"
             for name in ("function touchtrial::app::side(int)", "type touchtrial::app::Clock", "type touchtrial::app::Shape",
                          "variable touchtrial::app::kSides")])

    def test_c_functions_are_unique(self):
        self.assertEqual(violations({
            "app/a.cpp": header("touchtrial::app", 'extern "C" void handle(int signal) {}'),
            "device/b.cpp": header("touchtrial::device", 'extern "C" void handle(int) {}')}),
            ['function extern "C" handle is defined in app/a.cpp device/b.cpp'])

    def test_namespaces_of_other_rooms(self):
        self.assertEqual(violations({
            "core/guest.hpp": header("touchtrial::engine", "struct Guest {};"),
            "device/forward.hpp": header("touchtrial", "class Plane;") + "namespace touchtrial::device { struct Own {}; }",
            "device/inner.hpp": header("touchtrial::device::falcon", "struct Legs {};"),
            "device/qualified.hpp": header("touchtrial::device", before="inline int touchtrial::engine::stray() { return 1; }"),
            "device/standard.hpp": header("touchtrial::device", before="template <>\nstruct std::hash<A> {};"),
            "device/using.cpp": header("touchtrial::device", "using namespace touchtrial::engine;"),
            "device/using.hpp": header("touchtrial::device", "using namespace engine;"),
            "engine/global.hpp": header("touchtrial::engine", before="struct Global {};\nconstexpr int kGlobal = 3;"),
            "analysis/planning/power.hpp": header("touchtrial::analysis", "struct Power {};")}),
            ["analysis/planning/power.hpp does not open namespace touchtrial::planning",
             "analysis/planning/power.hpp opens namespace touchtrial::analysis",
             "core/guest.hpp does not open namespace touchtrial", "core/guest.hpp opens namespace touchtrial::engine",
             "device/qualified.hpp opens namespace touchtrial::engine", "device/using.hpp uses all of namespace engine",
             "engine/global.hpp defines Global in no namespace", "engine/global.hpp defines kGlobal in no namespace"])

    def test_hidden_headers(self):
        secret = header("touchtrial::engine", "struct Secret {};",
                        "Hidden from app/windows and app/seen.hpp, but for app/windows/preview.cpp: why.")
        indirect = header("touchtrial::engine", before='#include "engine/secret.hpp"')
        self.assertEqual(violations({
            "engine/secret.hpp": secret, "engine/way.hpp": indirect,
            "app/windows/screen.cpp": header("touchtrial::app", before='#include "engine/way.hpp"'),
            "app/windows/preview.cpp": header("touchtrial::app", before='#include "engine/secret.hpp"'),
            "app/seen.hpp": header("touchtrial::app"),
            "app/other.cpp": header("touchtrial::app", before='#include "engine/secret.hpp"')}),
            ["app/windows/screen.cpp reaches engine/secret.hpp, which is hidden from it"])

    def test_headers_without_guard_or_purpose_and_unpaired_brackets(self):
        self.assertEqual(violations({
            "core/bare.hpp": "namespace touchtrial {}\n",
            "core/branches.cpp": "namespace touchtrial {\n#if A\nstruct B {\n#else\nstruct C {\n#endif\n};\n}",
            "core/kernel-inl.hpp": "/// \\file Once for every target.\nnamespace touchtrial {}\n"}),
            ["core/bare.hpp does not begin with \\file", "core/bare.hpp has no #pragma once",
             "core/branches.cpp does not open namespace touchtrial",
             "core/branches.cpp has an unmatched bracket"])

    def test_messages_repeated_in_tests(self):
        messages = pinned_words.Messages({"core/a.cpp": 'f("the disk is full;"\n  " free some space");  // "of no use at all"\n'
                                                        'g("three words only"); h("SELECT a FROM b");'})
        self.assertEqual(len(messages.places), 1)
        for literal, is_repeated in (('"the disk is full"', True), ('"the disk "\n"is full"', True),
                                     ('R"(is full; free some)"', True), ('"the disk is 3 full"', True),
                                     ('"the disk is empty"', False), ('// "the disk is full"', False),
                                     ('TEST_CASE("the disk is full")', False), ('"disk is full: free"', True),
                                     ('"The Disk Is Full"', False), ('"free/some/space/now"', False)):
            found = list(pinned_words.pinning_literals(messages, {"tests/a.cpp": literal}, titles=set()))
            self.assertEqual(len(found), int(is_repeated), literal)
        self.assertEqual(list(pinned_words.pinning_literals(messages, {"tests/a.cpp": '"the disk is full"'},
                                                            titles={("the", "disk", "is", "full")})), [])


if __name__ == "__main__":
    unittest.main()
