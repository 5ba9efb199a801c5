#include "app/jitter/program.hpp"

int main(int argc, char** argv) {
  return touchtrial::jitter::run_program(argc, argv);
}
