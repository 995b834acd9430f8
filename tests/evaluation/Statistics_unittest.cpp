// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/Statistics.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

using namespace pointplane;

TEST(Statistics, handValues)
{
    const Statistics s = statisticsOf({1, 2, 3, 6});
    EXPECT_EQ(s.count, 4u);
    EXPECT_DOUBLE_EQ(s.mean, 3);
    EXPECT_DOUBLE_EQ(s.median, 2.5);
    EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(12.5));
    EXPECT_DOUBLE_EQ(s.std, std::sqrt(3.5));  // population, as numpy.std
    EXPECT_DOUBLE_EQ(s.min, 1);
    EXPECT_DOUBLE_EQ(s.max, 6);
}

TEST(Statistics, medianIsExactAtAnyScaleAndCount)
{
    std::mt19937 random(3);
    for (const std::size_t n : {1u, 2u, 3u, 10u, 999u, 1000u})
    {
        for (const double spread : {1e-9, 1.0, 30.0})
        {
            std::lognormal_distribution<double> values(0, spread);
            std::vector<double> v(n);
            std::generate(v.begin(), v.end(), [&] { return values(random); });
            const Statistics s = statisticsOf(v);
            std::sort(v.begin(), v.end());
            EXPECT_EQ(s.median, 0.5 * (v[(n - 1) / 2] + v[n / 2])) << n << " " << spread;
        }
    }
}

TEST(Statistics, medianOfManyEqualValuesAndZeros)
{
    std::vector<double> v(100, 0.0);
    EXPECT_EQ(statisticsOf(v).median, 0);
    v.insert(v.end(), 100, 7.0);
    EXPECT_EQ(statisticsOf(v).median, 3.5);
    EXPECT_DOUBLE_EQ(statisticsOf(v).std, 3.5);
}

TEST(Statistics, deviationOfNearlyEqualValuesDoesNotCancel)
{
    std::vector<double> v;
    for (int i = 0; i < 1000; ++i)
    {
        v.push_back(1000 + 1e-6 * (i % 2));
    }
    EXPECT_NEAR(statisticsOf(v).std, 0.5e-6, 1e-12);
}

TEST(Statistics, refusesWhatIsNotAnError)
{
    EXPECT_THROW((void)statisticsOf({}), std::runtime_error);
    EXPECT_THROW(
        (void)statisticsOf({1, std::numeric_limits<double>::quiet_NaN()}), std::runtime_error);
    EXPECT_THROW(
        (void)statisticsOf({1, std::numeric_limits<double>::infinity()}), std::runtime_error);
    EXPECT_THROW((void)statisticsOf({-1}), std::runtime_error);
}
