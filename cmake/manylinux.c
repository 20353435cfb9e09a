/* SPDX-FileCopyrightText: The limen authors
   SPDX-License-Identifier: Apache-2.0
   What g++ 12's libstdc++ wants of newer C libraries than Debian 11's; linked into what scripts/wheel makes. */
#include <stdlib.h>
#include <unistd.h>

char __libc_single_threaded = 0; /* never sure of it */

unsigned arc4random(void)
{
  unsigned value;
  if (getentropy(&value, sizeof value) != 0) abort();
  return value;
}
