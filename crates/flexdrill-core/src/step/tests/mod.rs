//! Tests of the steps that look at their insides.

mod balance;
mod ledger;
