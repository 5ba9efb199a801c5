#include "core/strict_json.hpp"

#include "core/errors.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <string>

using namespace touchtrial;

namespace {

std::string refusal_of_text(const std::string& text) {
  return message_of<StudyError>([&] { return parse_strict_json(text, "study.json"); });
}

}  // namespace

TEST_CASE("text after a zero byte is not ignored, and the message names the place") {
  using namespace std::string_literals;
  CHECK_THAT(refusal_of_text("{\"a\": 1}\n\0 {\"b\": 2}"s), names("study.json 2 1"));
  CHECK_THAT(refusal_of_text("{\"a\": 1}\0"s), names("study.json 1 9"));
  CHECK_THAT(refusal_of_text("{\"a\"\0: 1}"s), names("study.json 1 5"));
  CHECK_THAT(refusal_of_text("{\"a\": \"x\0y\"}"s), names("study.json 1 9"));
  CHECK(parse_strict_json("{\"a\": \"x\\u0000y\"}", "study.json").object({"a"}).at("a").text() ==
        "x\0y"s);
}

TEST_CASE("comments mean nothing, wherever they stand outside a text") {
  const std::string commented =
      "// first\n{ \"a\": /* in the middle */ 1, // of a line\n  \"b\": \"// a text\" }\n// last";
  const JsonObject object = parse_strict_json(commented, "study.json").object({"a", "b"});
  CHECK(object.at("a").integer(0, 9) == 1);
  CHECK(object.at("b").text() == "// a text");
  CHECK(without_comments(commented) == "{\n  \"a\": 1,\n  \"b\": \"// a text\"\n}\n");
  CHECK(without_comments("{\"b\":1, \"a\":2}") == "{\"b\":1, \"a\":2}");
  CHECK_THAT(refusal_of_text("// one\n{\"a\": 1,}"), names("study.json 2 9"));
  CHECK_THAT(refusal_of_text("{\"a\": 1} /* open"), names("study.json 1"));
  CHECK_THAT(refusal_of_text("{\"a\": 1} # no comment"), names("study.json 1"));
}

TEST_CASE("an object with anybody's keys is handed on as JSON, without its comments") {
  const JsonObject object =
      parse_strict_json("{\"a\": {\"b\": [1, 2.5], /* c */ \"d\": \"\\u0000\"}, \"e\": 1}",
                        "x.json")
          .object({"a", "e"});
  CHECK(object.at("a").object_text() == R"({"b":[1,2.5],"d":"\u0000"})");
  CHECK_THROWS_WITH(object.at("e").object_text(), names("x.json /e"));
}
