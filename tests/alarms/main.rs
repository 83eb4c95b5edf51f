//! What the motion means for an operator: the whirl analysis on the real mechanics, and the alarms made of it.

mod advice;
mod book;
mod whirl;
mod words;
