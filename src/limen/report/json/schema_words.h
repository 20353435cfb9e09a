// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>

#include "limen/report/json/json_values.h"

/// The words that the JSON Schemas of limen's files are made of (draft 2020-12).
namespace limen::schema {

Json ref(const char* name);
/// A definition or null.
Json nullable(const char* name);
Json number(const char* description);
/// Null: it is not known, or not finite.
Json number_or_null(const char* description);
Json whole(const char* description);
Json text(const char* description);
Json flag(const char* description);
Json words(std::initializer_list<const char*> all);
Json list_of(const Json& items, const char* description);
/// `count` numbers.
Json numbers(int count, const char* description);
/// `count` numbers, null where they are not finite.
Json numbers_or_null(int count, const char* description);
/// A square matrix, row by row.
Json rows(int count, const char* description);
/// An object with these fields; `required` of them are always there.
Json object(Json properties, std::initializer_list<const char*> required);

/// Where a scanner stood and how that is known.
Json scanner_schema();
/// One standard deviation of a pose.
Json pose_sigma_schema();

/// The whole schema as text.
std::string schema_text(const char* title, Json fields, Json definitions);

}  // namespace limen::schema
