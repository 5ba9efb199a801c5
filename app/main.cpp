#include "app/program.hpp"

int main(int argc, char** argv) {
  return touchtrial::run_program(argc, argv);
}
