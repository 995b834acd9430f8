// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/number_text.h>

#include <clocale>
#include <cmath>
#include <cstdint>
#include <limits>
#include <locale>
#include <string>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** 1.234,5 */
struct DecimalComma : std::numpunct<char>
{
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

/** A program whose locale has decimal commas: in C++, and in C where the system has such a one. */
class NumberTextInOtherLocale : public ::testing::Test
{
 protected:
    void SetUp() override
    {
        std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
        std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
    }
    void TearDown() override { std::locale::global(std::locale::classic()); }
};

TEST(NumberText, readsNumbers)
{
    EXPECT_EQ(parseNumber<double>("0.25"), 0.25);
    EXPECT_EQ(parseNumber<double>("-2.5e-3"), -2.5e-3);
    EXPECT_EQ(parseNumber<double>("+3"), 3);
    EXPECT_EQ(parseNumber<double>("5."), 5);
    EXPECT_EQ(parseNumber<double>(".5"), 0.5);
    EXPECT_EQ(parseNumber<int>("-17"), -17);
    EXPECT_EQ(parseNumber<int>("+17"), 17);
    EXPECT_EQ(parseNumber<std::uint64_t>("18446744073709551615"), UINT64_MAX);
}

TEST(NumberText, refusesTextsThatAreNoNumberAsAWhole)
{
    for (const char* text :
         {"",
          "+",
          "-",
          "--1",
          "++1",
          "+-1",
          "-+1",
          " 1",
          "1 ",
          "1\r",
          "1 m",
          "0,25",
          "1e",
          "0x10",
          "1'000",
          "1.2.3",
          "one"})
    {
        EXPECT_FALSE(parseNumber<double>(text)) << text;
        EXPECT_FALSE(parseNumber<int>(text)) << text;
    }
    EXPECT_FALSE(parseNumber<int>("2.5"));
    EXPECT_FALSE(parseNumber<unsigned>("-1"));
}

TEST(NumberText, refusesNumbersThatDoNotFit)
{
    EXPECT_FALSE(parseNumber<double>("1e999"));
    EXPECT_FALSE(parseNumber<int>("2147483648"));
    EXPECT_FALSE(parseNumber<std::uint64_t>("18446744073709551616"));
}

TEST(NumberText, finiteNumbersAreNeitherNanNorInfinity)
{
    EXPECT_TRUE(std::isnan(parseNumber<double>("nan").value()));
    EXPECT_EQ(parseNumber<double>("-inf"), -std::numeric_limits<double>::infinity());
    EXPECT_FALSE(parseFinite("nan"));
    EXPECT_FALSE(parseFinite("-inf"));
    EXPECT_FALSE(parseFinite("x"));
    EXPECT_EQ(parseFinite("1e300"), 1e300);
}

TEST(NumberText, shortestTextReadsBackAsTheSameNumber)
{
    EXPECT_EQ(numberText(0.1), "0.1");
    EXPECT_EQ(numberText(-2), "-2");
    for (const double value : {1.0 / 3, 1e-310, -1.7976931348623157e308, 1305031102.175304})
    {
        EXPECT_EQ(parseNumber<double>(numberText(value)), value);
    }
}

TEST(NumberText, decimalsAndWidth)
{
    EXPECT_EQ(numberText(3.14159, 2), "3.14");
    EXPECT_EQ(numberText(-0.5, 0), "-0");
    EXPECT_EQ(numberText(2, 3, 8), "   2.000");
    EXPECT_EQ(numberText(123456, 1, 4), "123456.0");
    EXPECT_EQ(numberText(std::nan(""), 2, 5), "  nan");
    EXPECT_EQ(numberText(-std::numeric_limits<double>::infinity(), 2), "-inf");
}

TEST(NumberText, manyDigitsAreInScientificForm)
{
    EXPECT_EQ(numberText(999999999999, 1), "999999999999.0");
    EXPECT_EQ(numberText(1e12, 2), "1.00e+12");
    EXPECT_EQ(numberText(-1.5e200, 3, 12), " -1.500e+200");
}

TEST_F(NumberTextInOtherLocale, numbersAreTheSame)
{
    EXPECT_EQ(parseNumber<double>("1234.5"), 1234.5);
    EXPECT_FALSE(parseNumber<double>("1234,5"));
    EXPECT_EQ(numberText(1234.5), "1234.5");
    EXPECT_EQ(numberText(1234.5, 2), "1234.50");
    std::ostringstream ofProgram, out = numberStream();
    ofProgram << 1234.5;
    out << 1234.5;
    EXPECT_EQ(ofProgram.str(), "1.234,5");
    EXPECT_EQ(out.str(), "1234.5");
}
}  // namespace
}  // namespace pointplane
