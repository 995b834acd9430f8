// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "OdometryApp.h"

int main(int argc, char** argv)
{
    return pointplane::runOdometry({argv + 1, argv + argc}, std::cout, std::cerr);
}
