// Copyright 2026 ballscrew_monitor contributors
// SPDX-License-Identifier: Apache-2.0
// A page of tables alone.

'use strict';

document.querySelectorAll('table.sortable').forEach(Table.sortable);
Table.tellWidth();
document.body.dataset.ready = 'true';
