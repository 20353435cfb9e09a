// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/program.h"

int main(int argc, char** argv) {
  return limen::run_program(argc, argv);
}
