/* SPDX-License-Identifier: MIT
 *
 * variant: gives a test the sizes of a link layer that was compiled with other options.
 */
#include "link.h"

U32 LinkVariant_size(void);
U32 LinkVariant_maxMessage(void);

U32 LinkVariant_size(void) {
    return (U32)sizeof(Link);
}

U32 LinkVariant_maxMessage(void) {
    return LINK_MAX_MESSAGE;
}
