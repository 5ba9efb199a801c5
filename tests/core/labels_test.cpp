#include "core/labels.hpp"

#include "support/catch.hpp"
#include "support/names.hpp"

#include <string>
#include <utility>
#include <vector>

using namespace touchtrial;

namespace {

const std::string kCyrillic = "\xd1\x81\xd0\xbe\xd1\x80\xd0\xba";  // looks like copk

}  // namespace

TEST_CASE("a label may have letters of any alphabet, but a word of Latin ones no others") {
  for (const std::string& label : std::vector<std::string>{
           "cork", std::string(64, 'x'),
           "\xc3\xa9"
           "corce d'arbre",
           "Noe\xcc\x88l", kCyrillic, "cork " + kCyrillic, "\xce\xb2-keratin", "50 \xc2\xb5m",
           "STRA\xe1\xba\x9e"
           "E",
           "T\xe6\x81\xa4"}) {
    CAPTURE(label);
    CHECK(fault_of_label(label).empty());
  }
  for (const std::string& label :
       std::vector<std::string>{"c\xd0\xberk", "\xce\x91lpaca", "", "latin\xe9",
                                std::string(65, 'x'), "a\nb", "a\xc2\x85z", "a ", "nan", "=1"}) {
    CAPTURE(label);
    CHECK_FALSE(fault_of_label(label).empty());
  }
  CHECK((alphabets_of("cork").latin && !alphabets_of("cork 9").non_latin));
  CHECK((!alphabets_of(kCyrillic).latin && alphabets_of(kCyrillic).non_latin));
}

TEST_CASE("labels of several alphabets are to be looked at, those of one are not") {
  CHECK(remark_on_alphabets({"cork", "silk"}).empty());
  CHECK(remark_on_alphabets({kCyrillic, "9"}).empty());
  CHECK_THAT(remark_on_alphabets({"cork", "silk", kCyrillic}), names("cork 1 " + kCyrillic));
}
