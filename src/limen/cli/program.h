// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limen {

/// The whole command line; returns the exit status of the contract.
int run_program(int argc, char** argv);

}  // namespace limen
