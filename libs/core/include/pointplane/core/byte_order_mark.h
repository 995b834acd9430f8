// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <istream>

namespace pointplane
{
/** Leaves out the mark that some editors put in front of UTF-8. No other text that is read here
 * begins with its first byte. */
inline void skipByteOrderMark(std::istream& text)
{
    constexpr int kFirstByte = 0xEF;
    constexpr int kBytes = 3;
    if (text.peek() == kFirstByte)
    {
        text.ignore(kBytes);
    }
    text.clear(text.rdstate() & ~std::ios::eofbit);  // of an empty file: not yet read
}
}  // namespace pointplane
