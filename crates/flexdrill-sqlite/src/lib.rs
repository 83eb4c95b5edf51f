//! Reads rosbag2's SQLite storage (`.db3`): after [`read_sqlite`], [`flexdrill_bag::open`] opens such files too.

use std::collections::{HashMap, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use flexdrill_bag::{BagError, BagFile, RawMessage, Topic, qos_from_yaml, read_sqlite_with};
use flexdrill_messages::find_type;
use rusqlite::limits::Limit;
use rusqlite::{Connection, OpenFlags, Row, params};

/// Rows per query.
const BATCH: i64 = 256;
/// Length limit of a text or blob in a small file (bytes).
const SMALL: u64 = 1 << 20;

/// From now on this program opens SQLite files of rosbag2.
pub fn read_sqlite() {
    read_sqlite_with(|path| Ok(Box::new(SqliteFile::open(path)?)));
}

/// An open database.
struct SqliteFile {
    path: PathBuf,
    connection: Connection,
    topics: Vec<Arc<Topic>>,
    /// Index of a topic by its id in the database.
    topic_of: HashMap<i64, usize>,
    wanted: Vec<bool>,
    batch: VecDeque<RawMessage>,
    /// Time and id of the last row fetched.
    last: Option<(i64, i64)>,
    finished: bool,
    messages: u64,
    bounds: Option<(i64, i64)>,
}

impl SqliteFile {
    /// Opens the file and reads its topics.
    ///
    /// # Errors
    /// When the file is not a database of rosbag2.
    fn open(path: &Path) -> Result<Self, BagError> {
        let connection = Connection::open_with_flags(path, OpenFlags::SQLITE_OPEN_READ_ONLY).map_err(error(path))?;
        limit_cost(&connection, path)?;
        let mut stream = Self {
            path: path.to_owned(),
            connection,
            topics: Vec::new(),
            topic_of: HashMap::new(),
            wanted: Vec::new(),
            batch: VecDeque::new(),
            last: None,
            finished: false,
            messages: 0,
            bounds: None,
        };
        stream.read_topics().map_err(error(path))?;
        stream.wanted = vec![true; stream.topics.len()];
        Ok(stream)
    }

    fn read_topics(&mut self) -> rusqlite::Result<()> {
        let definitions = definitions(&self.connection)?;
        let hashed = has_column(&self.connection, "topics", "type_description_hash")?;
        let qos_known = has_column(&self.connection, "topics", "offered_qos_profiles")?;
        let mut statement = self.connection.prepare(&format!(
            "SELECT id, name, type, serialization_format, {}, {} FROM topics ORDER BY id",
            if qos_known { "offered_qos_profiles" } else { "''" },
            if hashed { "type_description_hash" } else { "''" },
        ))?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            let ros_type: String = row.get(2)?;
            let (schema_encoding, schema) = match (definitions.get(&ros_type), find_type(&ros_type)) {
                (Some(definition), _) => definition.clone(),
                (None, Some(known)) => ("ros2msg".to_owned(), known.schema.to_owned()),
                (None, None) => Default::default(),
            };
            let topic = Topic {
                name: row.get(1)?,
                ros_type,
                encoding: row.get(3)?,
                schema,
                schema_encoding,
                type_hash: row.get(5)?,
                qos: qos_from_yaml(&row.get::<_, String>(4)?),
            };
            self.topic_of.insert(row.get(0)?, self.topics.len());
            self.topics.push(Arc::new(topic));
        }
        let (count, first, last): (i64, Option<i64>, Option<i64>) = self.connection.query_row(
            "SELECT COUNT(*), MIN(timestamp), MAX(timestamp) FROM messages",
            [],
            |row| Ok((row.get(0)?, row.get(1)?, row.get(2)?)),
        )?;
        self.messages = u64::try_from(count).unwrap_or(0);
        self.bounds = first.zip(last);
        Ok(())
    }

    fn fetch(&mut self) -> rusqlite::Result<()> {
        let after = self.last.unwrap_or((i64::MIN, i64::MIN));
        let mut statement = self.connection.prepare_cached(
            "SELECT id, topic_id, timestamp, data FROM messages \
             WHERE timestamp >= ?1 AND (timestamp, id) > (?1, ?2) ORDER BY timestamp, id LIMIT ?3",
        )?;
        let mut rows = statement.query(params![after.0, after.1, BATCH])?;
        let mut count = 0;
        while let Some(row) = rows.next()? {
            count += 1;
            let (id, log_time): (i64, i64) = (row.get(0)?, row.get(2)?);
            self.last = Some((log_time, id));
            if let Some(message) = message(row, log_time, &self.topic_of, &self.wanted)? {
                self.batch.push_back(message);
            }
        }
        self.finished = count < BATCH;
        Ok(())
    }
}

impl BagFile for SqliteFile {
    fn topics(&self) -> &[Arc<Topic>] {
        &self.topics
    }

    fn set_wanted(&mut self, wanted: Vec<bool>) {
        self.wanted = wanted;
    }

    fn messages(&self) -> Option<u64> {
        Some(self.messages)
    }

    fn bounds(&self) -> Option<(i64, i64)> {
        self.bounds
    }

    fn seek(&mut self, time: i64) {
        self.batch.clear();
        self.finished = false;
        self.last = time.checked_sub(1).map(|before| (before, i64::MAX));
    }

    fn next(&mut self) -> Option<Result<RawMessage, BagError>> {
        while self.batch.is_empty() && !self.finished {
            if let Err(problem) = self.fetch() {
                self.finished = true;
                return Some(Err(error(&self.path)(problem)));
            }
        }
        self.batch.pop_front().map(Ok)
    }
}

/// Keeps the cost of reading in proportion to the file's size: a malicious file may define tables whose rows SQLite
/// computes, without end or of any size.
fn limit_cost(connection: &Connection, path: &Path) -> Result<(), BagError> {
    let mut log = path.as_os_str().to_owned();
    log.push("-wal");
    // The newest rows may be in the write-ahead log alone.
    let logged = std::fs::metadata(log).map_or(0, |file| file.len());
    let size = std::fs::metadata(path)
        .map_err(|source| unreadable(path, source))?
        .len()
        + logged;
    let longest = i32::try_from(size.max(SMALL)).unwrap_or(i32::MAX);
    connection
        .set_limit(Limit::SQLITE_LIMIT_LENGTH, longest)
        .map_err(error(path))?;
    for table in ["topics", "messages"] {
        if !is_table(connection, table).map_err(error(path))? {
            return Err(BagError::NotABag {
                path: path.to_owned(),
                problem: format!("it has no ordinary table `{table}`, as rosbag2 writes it"),
            });
        }
    }
    Ok(())
}

/// Whether an ordinary table has this name. A view or a virtual table has no root page.
fn is_table(connection: &Connection, name: &str) -> rusqlite::Result<bool> {
    let count: i64 = connection.query_row(
        "SELECT COUNT(*) FROM sqlite_master WHERE type = 'table' AND rootpage > 0 AND name = ?1",
        [name],
        |row| row.get(0),
    )?;
    Ok(count > 0)
}

/// The message of a row, if its topic is wanted.
fn message(
    row: &Row<'_>,
    log_time: i64,
    topic_of: &HashMap<i64, usize>,
    wanted: &[bool],
) -> rusqlite::Result<Option<RawMessage>> {
    let topic_id: i64 = row.get(1)?;
    let Some(&topic) = topic_of.get(&topic_id) else {
        return Ok(None);
    };
    if !wanted.get(topic).copied().unwrap_or(false) {
        return Ok(None);
    }
    Ok(Some(RawMessage {
        log_time,
        order: 0,
        publish_time: log_time,
        topic,
        sequence: None,
        data: row.get(3)?,
    }))
}

/// Encoding and text of the message definitions, by type; older bags have none.
fn definitions(connection: &Connection) -> rusqlite::Result<HashMap<String, (String, String)>> {
    if !is_table(connection, "message_definitions")? {
        return Ok(HashMap::new());
    }
    let mut statement =
        connection.prepare("SELECT topic_type, encoding, encoded_message_definition FROM message_definitions")?;
    let rows = statement.query_map([], |row| Ok((row.get(0)?, (row.get(1)?, row.get(2)?))))?;
    rows.collect()
}

fn has_column(connection: &Connection, table: &str, column: &str) -> rusqlite::Result<bool> {
    let count: i64 = connection.query_row(
        "SELECT COUNT(*) FROM pragma_table_info(?1) WHERE name = ?2",
        [table, column],
        |row| row.get(0),
    )?;
    Ok(count > 0)
}

fn unreadable(path: &Path, source: std::io::Error) -> BagError {
    BagError::Io {
        action: "read",
        path: path.to_owned(),
        source,
    }
}

fn error(path: &Path) -> impl FnOnce(rusqlite::Error) -> BagError {
    let path = path.to_owned();
    move |source| BagError::Sqlite {
        path,
        source: source.into(),
    }
}
